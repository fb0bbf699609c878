"""The figures that the paper prints, and what follows from them."""
from records import read_json
from script import ROOT

PAPER = read_json(ROOT / "bench" / "tables" / "published.json")


def over(figure, ratio, decimals):
    """The range of figure / x for all x that are printed as `ratio` with so many decimals. The figure is taken as it is printed."""
    half = 0.5 * 10.0 ** -decimals
    return figure / (ratio + half), figure / (ratio - half)
