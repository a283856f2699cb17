"""What the page says of rows."""

import re
import unittest
from dataclasses import asdict

from benchmarks.contenders import CONTENDERS, Contender
from benchmarks.page import PLOTS, page
from benchmarks.plan import FULL
from benchmarks.rows import Row
from benchmarks.tables import by_size, calls, results

from .examples import case, row

SETTING = {
    "date": "2026-01-01",
    "commit": "abc",
    "processor": "some",
    "cores": 2,
    "gibibytes": 8,
    "system": "Debian",
    "python": "3.11",
    "load": 0.1,
    "quick": False,
    "plan": asdict(FULL),
}


def cells(table: str) -> dict[str, list[str]]:
    """The lines of a table by their first cells."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
    widths = {len(line) for line in lines}
    assert len(widths) == 1, f"lines of different lengths: {widths}"
    return {line[0]: line[1:] for line in lines}


class Results(unittest.TestCase):
    def test_who_is_on_a_front_is_bold_there_alone(self) -> None:
        table = cells(
            results(
                [
                    row("fast", 1e-3, 4e-3, 1e-1),
                    row("close", 2e-3, 1e-3, 2e-1),
                    row("cheat", 1e-4, 1e-4, 1e-4, triangles=500),
                    row("two", 1e-4, 1e-4, 1e-4, cores=2),
                    Row(case(), "absent", failure="not installed"),
                ]
            )
        )
        self.assertEqual(table["fast"], ["100", "1.0", "750.0", "1.00", "50", "**4.00e-03**", "**1.00e-01**"])
        self.assertEqual(table["close"][-2:], ["**1.00e-03**", "2.00e-01"])
        self.assertEqual(table["cheat"][0], "500 *missed*")
        self.assertEqual(table["cheat"][-2:], ["1.00e-04", "1.00e-04"])
        self.assertEqual(table["two"][-2:], ["1.00e-04", "1.00e-04"])
        self.assertEqual(table["absent"][0], "*not installed*")


class Sizes(unittest.TestCase):
    def test_what_was_not_run_is_empty(self) -> None:
        contenders = [Contender(name, name, "") for name in ("fast", "slow")]
        rows = [
            row("fast", 1e-3, 1.0, case=case("small")),
            row("slow", 1e-2, 1.0, case=case("small")),
            row("fast", 2e-2, 1.0, case=case("large", triangles_in=10_000), triangles=500),
            Row(case("large", triangles_in=10_000), "slow", failure="not run"),
        ]
        table = cells(by_size(rows, contenders, lambda row: row.microseconds_per_triangle, digits=2))
        self.assertEqual(table[""], ["1,000", "10,000"])
        self.assertEqual(table["fast"], ["1.00", "2.00 *missed*"])
        self.assertEqual(table["slow"], ["10.00", ""])


class Calls(unittest.TestCase):
    def test_troubles_are_told_once(self) -> None:
        contenders = [Contender(name, name, "`call`") for name in ("absent", "slow", "cheat")]
        rows = [
            *(Row(case(mesh), "absent", failure="not installed") for mesh in ("a", "b")),
            row("slow", 1.0, 1.0, case=case("a")),
            Row(case("b"), "slow", failure="stopped"),
            row("cheat", 1.0, 1.0, case=case("a"), triangles=500),
        ]
        table = cells(calls(rows, contenders))
        self.assertEqual(table["absent"], ["-", "`call`", "not installed"])
        self.assertEqual(table["slow"], ["slow 1.0", "`call`", "b: stopped"])
        self.assertEqual(table["cheat"][-1], "missed the count in 1 of 1 cases")


class Page(unittest.TestCase):
    def test_has_every_plot_and_every_row(self) -> None:
        rows = [row(contender.name, 1e-3, 1e-3) for contender in CONTENDERS]
        rows += [
            row(contender.name, 1e-3, 1e-3, case=case("statue", series="sizes", wanted=10)) for contender in CONTENDERS
        ]
        text = page(SETTING, rows, CONTENDERS, "benchmarks")
        self.assertEqual(re.findall(r"\]\(benchmarks/(.*\.svg)\)", text), list(PLOTS))
        self.assertIn("### bunny: 1,000 to 100\n", text)
        self.assertIn("### statue: 1,000 to 10\n", text)


class Table(unittest.TestCase):
    def test_of_contenders_has_names_that_are_one_s_own(self) -> None:
        names = [contender.name for contender in CONTENDERS]
        self.assertEqual(len(names), len(set(names)))


if __name__ == "__main__":
    unittest.main()
