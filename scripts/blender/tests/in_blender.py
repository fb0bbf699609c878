"""Installs the add-on in Blender, checks a character, and holds the events against an answer of cscd query about the same file.

  blender --background --factory-startup --python-exit-code 1 --python in_blender.py -- ADD-ON.zip CHARACTER.glb ANSWER.json CACHE.json

CHARACTER.glb has one clip, and ANSWER.json is about that clip. CACHE.json is an answer about a mesh cache beside it.
"""
import json
import math
import pathlib
import sys

import bpy
import numpy

addon, character, answer, cache = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.preferences.addon_install(filepath=str(pathlib.Path(addon).resolve()))
bpy.ops.preferences.addon_enable(module="cscd_self_collision")
import cscd_self_collision as installed  # noqa: E402  (after it is installed)

scene = bpy.context.scene
settings = scene.cscd_self_collision
there = set(scene.objects.keys())
query = json.loads(pathlib.Path(answer).read_text())
clip = query["import"]["clips"][query["import"]["clip"]]
scene.render.fps = round(query["import"]["fps"])
scene.frame_start = round(clip["first_frame"])
scene.frame_end = scene.frame_start + clip["frames"] - 1
numpy.bool = bool  # Debian's importer of glTF asks for a name that Debian's numpy has no more
bpy.ops.import_scene.gltf(filepath=character)
armature = next(o for o in bpy.context.selected_objects if o.type == "ARMATURE")
bpy.ops.object.select_all(action="DESELECT")
armature.select_set(True)
scene.frame_set(scene.frame_end)


def same(one, other, what):
    assert one == other, f"{what}: {one} and {other}"


def events_of(found):
    return sorted((*e.names, e.begins, e.deepest, e.ends) for e in found if not e.touches)


# Blender poses in single precision, so that depths differ in the sixth digit. Pairs and frames are the same.
same(bpy.ops.cscd_self_collision.check(), {"FINISHED"}, "a check")
found = installed.Result.events
asked = query["summary"]["events"]
assert asked, "the character does not lie in itself"
same(events_of(found), sorted((e["first"], e["second"], *(e[at]["frame"] for at in ("begins", "deepest", "ends"))) for e in asked),
     "events in Blender and of cscd query")
for event in (e for e in found if not e.touches):
    near = [e for e in asked if (e["first"], e["second"], e["begins"]["frame"]) == (*event.names, event.begins)]
    assert any(math.isclose(event.depth, e["depth"]["at_least"], rel_tol=1e-4, abs_tol=1e-6) for e in near), (event, near)
    assert any(event.at_joint == e["at_joint"] for e in near), (event, near)
headline = query["summary"]["headline"]
assert settings.headline.startswith(f"{headline['first']} is "), (settings.headline, headline)
assert f"deepest at frame {headline['deepest']['frame']:g} " in settings.headline, (settings.headline, headline)
met = {frozenset((pair["first"], pair["second"])) for pair in query["summary"]["met"]}
assert {frozenset(e.names) for e in found} <= met, ("touches that cscd query does not know", found, met)

# What is shown of it; the scene is otherwise as it was.
shown = [e for e in found if not e.at_joint]
same(len(settings.rows), len(shown), "rows")
same(sorted(m.frame for m in scene.timeline_markers), sorted(math.floor(e.deepest) for e in shown), "markers")
same((scene.frame_current, armature.data.pose_position), (scene.frame_end, "POSE"), "frame and pose")
assert there <= set(scene.objects.keys()), "objects of the open scene are gone"
mesh = next(o for o in scene.objects if o.find_armature() == armature)
group = mesh.vertex_groups[installed.NAME]
weights = [g.weight for v in mesh.data.vertices for g in v.groups if g.group == group.index]
assert 0 < len(weights) < len(mesh.data.vertices) and math.isclose(max(weights), 1) and min(weights) >= 0.0999, weights
lines = [o for o in scene.objects if installed.OURS in o]
assert lines and all(o.type == "CURVE" for o in lines), lines
settings.active = 0
row = settings.rows[0]
same(scene.frame_current, row.frame, "the frame after a click")
same(sorted(o.name for o in lines if not o.evaluated_get(bpy.context.evaluated_depsgraph_get()).hide_viewport),
     sorted(o.name for o, r in zip(lines, settings.rows) if r.frame == row.frame), "curves shown in that frame")
pair = {row.first, row.second}
bpy.ops.cscd_self_collision.ignore(row=0)
assert all({r.first, r.second} != pair for r in settings.rows) and settings.ignored, "an ignored pair is listed"
bpy.ops.cscd_self_collision.heed(pair=0)
same(len(settings.rows), len(shown), "rows after the pair counts again")
settings.count_folds = True
same(len(settings.rows), len(found), "rows with folds")
settings.thickness, scene.frame_end = 0.01 * max(mesh.dimensions), scene.frame_start + 12
bpy.ops.cscd_self_collision.check()
assert "comes within " in settings.rows[-1].sentence, settings.rows[-1].sentence
settings.thickness, scene.frame_end = 0, scene.frame_start + 2
more = mesh.modifiers.new("more", "SUBSURF")
same(bpy.ops.cscd_self_collision.check(), {"FINISHED"}, "a check with a modifier that makes vertices")
assert installed.NAME not in mesh.vertex_groups, "weights on vertices that the check did not see"
mesh.modifiers.remove(more)
mesh.modifiers.new("fewer", "DECIMATE").ratio = 0.5
try:
    bpy.ops.cscd_self_collision.check()
    raise AssertionError("faces that change from frame to frame are taken")
except RuntimeError as error:
    assert "has other faces at frame" in str(error), error
bpy.ops.cscd_self_collision.clear()
same((len(settings.rows), len(scene.timeline_markers), sum(installed.OURS in o for o in scene.objects)), (0, 0, 0), "what is left")

# An answer about a cache: the mesh stands upright, follows it, and shows the same events, without the module.
query = json.loads(pathlib.Path(cache).read_text())
same(bpy.ops.cscd_self_collision.load(filepath=cache), {"FINISHED"}, "an answer")
first = round(query["import"]["clips"][0]["first_frame"])
same(events_of(installed.Result.events), sorted((e["first"], e["second"], *(e[at]["frame"] for at in ("begins", "deepest", "ends")))
                                                for e in query["summary"]["events"]), "events of the answer")
surface = scene.objects[installed.Result.objects[0]]
event = next(e for e in installed.Result.events if e.depth > 0)
scene.frame_set(round(event.deepest))
moved = surface.evaluated_get(bpy.context.evaluated_depsgraph_get())
nearest = min((moved.matrix_world @ v.co - installed.Vector(event.point)).length for v in moved.data.vertices)
assert nearest < 1e-3 * max(surface.dimensions), f"the deepest point is {nearest} away from the surface"
assert installed.NAME in surface.vertex_groups, "no weights of what touches"
print("The add-on and cscd query agree.")
