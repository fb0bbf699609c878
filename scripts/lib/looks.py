"""Colours, dashes, order and titles, which the report's page has too."""
from records import read_json
from script import ROOT

LOOKS = read_json(ROOT / "bench" / "tables" / "looks.json")
