"""Whether scenes/fit.md, which scripts/fit-scenes writes, is of the scene files as they are."""
from records import read_json
from script import ROOT

PAGE = ROOT / "scenes" / "fit.md"
SCENES = ("rope", "hand", "octopus", "man")


def digests(scenes):
    return {scene: read_json(ROOT / "scenes" / f"{scene}.json")["expected"]["digest"] for scene in scenes}


def faults():
    text = PAGE.read_text()
    stale = [scene for scene, digest in digests(SCENES).items() if f"| {scene} | `{digest}` |" not in text]
    return [f"scenes/fit.md: was made of other frames of {', '.join(stale)}; run scripts/fit-scenes --out scenes/fit.md"] if stale else []
