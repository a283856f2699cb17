"""decimesh beside the simplifiers that anybody can install: time, memory and error, as a page with plots.

`scripts/benchmarks.sh` installs and builds what this needs, and calls it; `__main__.py` says what happens then.
Only `peers/` and `plots.py` need packages beyond Python's own.
"""
