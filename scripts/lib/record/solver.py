"""Measures small steps, as a solver takes them: on scenes, on cloth, and on steps of real simulations.

  scripts/record solver
  scripts/record solver --real ../shared/real     and on every point cache (.h5) of that folder

`base`, `selfccd`, `drvbc_fast_complete` and the engine with its list of what is near (`drvbc_fast_near`) answer substeps, trials of a line
search and iterations that move from a thousandth of a mean edge to a whole one, with and without a thickness. Every answer is held
against `base` with the exact test before it is timed (`cscd scale --study small`). Writes the record, and its page, to a new folder
results/DATE-MACHINE-COMMIT-solver. Takes a quarter of an hour on 2 idle cores when everything is built, most of it `base`; with
--real more than an hour, for all the contacts of those steps.
"""
from scale_study import measure_study


def main():
    measure_study(__doc__, "small", "solver", "a quarter of an hour, with --real more than an hour,")
