"""Measures what a thickness costs: on the scenes, on cloth, and on steps of real simulations.

  scripts/record thickness
  scripts/record thickness --real ../shared/real     and on every point cache (.h5) of that folder

`base`, whose boxes grow by the thickness, `drvbc_fast` and `drvbc_fast_complete` answer the same intervals at thicknesses from 0 to 1 mean
edge. Every answer is held against `base` with the exact test before it is timed (`cscd scale --study thickness`). Writes the record, and
its page, to a new folder results/DATE-MACHINE-COMMIT-thickness. Takes a quarter of an hour on 2 idle cores when everything is built, most of it `base`.
"""
from scale_study import measure_study


def main():
    measure_study(__doc__, "thickness", "thickness", "a quarter of an hour")
