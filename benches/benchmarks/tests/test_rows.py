"""The file of rows, as an interruption leaves it too."""

import tempfile
import unittest
from pathlib import Path

from benchmarks.rows import Row, RowFile
from benchmarks.setting import same

from .examples import case, row

SETTING = {"commit": "abc", "processor": "some", "cores": 2, "quick": False, "plan": {"runs": 5}, "date": "2026-01-01"}


class File(unittest.TestCase):
    def setUp(self) -> None:
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.file = RowFile(Path(directory.name) / "new" / "rows.jsonl")
        self.rows = [row("one", 1e-3, 0.5), Row(case(), "other", failure='says "no"')]
        self.file.begin(SETTING)
        for one in self.rows:
            self.file.append(one)

    def test_gives_back_what_it_was_given(self) -> None:
        self.assertEqual(self.file.read(), (SETTING, self.rows))

    def test_a_row_cut_off_at_any_byte_is_measured_again(self) -> None:
        contents = self.file.path.read_bytes()
        begin = contents.rstrip(b"\n").rfind(b"\n") + 1
        for cut in range(begin, len(contents)):
            self.file.path.write_bytes(contents[:cut])
            self.assertEqual(self.file.read(), (SETTING, self.rows[:1]), cut)
            self.file.append(self.rows[1])
            self.assertEqual(self.file.path.read_bytes(), contents, cut)

    def test_refuses_other_files(self) -> None:
        for text in ["", '{"case": 1}\n']:
            self.file.path.write_text(text)
            with self.assertRaises(ValueError):
                self.file.read()


class Reached(unittest.TestCase):
    def test_allows_one_percent_more_and_ten_fewer(self) -> None:
        wanted = {"case": case(triangles_in=100_000, wanted=10_000)}
        for triangles, reached in [(9_000, True), (10_100, True), (8_999, False), (10_101, False)]:
            self.assertEqual(row("one", 1.0, 1.0, triangles=triangles, **wanted).reached, reached, triangles)

    def test_needs_a_distance(self) -> None:
        self.assertFalse(Row(case(), "one", failure="no").reached)


class Settings(unittest.TestCase):
    def test_of_other_days_go_together_and_of_other_commits_or_plans_do_not(self) -> None:
        self.assertTrue(same(SETTING, SETTING | {"date": "2026-01-02"}))
        self.assertFalse(same(SETTING, SETTING | {"commit": "def"}))
        self.assertFalse(same(SETTING, SETTING | {"plan": {"runs": 3}}))


if __name__ == "__main__":
    unittest.main()
