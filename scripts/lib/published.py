"""Figures that follow from those that the paper prints."""


def over(figure, ratio, decimals):
    """The range of figure / x for all x that are printed as `ratio` with so many decimals. The figure is taken as it is printed."""
    half = 0.5 * 10.0 ** -decimals
    return figure / (ratio + half), figure / (ratio - half)
