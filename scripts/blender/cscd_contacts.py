"""Shows in Blender where a moving surface touches itself.

  cscd query walk.pc2 --json walk.json
  blender --python scripts/blender/cscd_contacts.py -- walk.obj walk.pc2 walk.json
  blender --background --python scripts/blender/cscd_contacts.py -- walk.obj walk.pc2 walk.json --save walk.blend

The three files are a mesh, its cache (.pc2 or .mdd) and an answer of `cscd query` about that cache; `cscd export INPUT
walk.pc2` writes the first two. The scene gets

  - the surface with its cache, and a vertex group `touching` of all vertices that have a contact;
  - a collection `contacts` with a cloud of points for each interval that touches, shown in the frame in which the interval
    begins;
  - a marker on the time line at the first contact, at the worst interval, and wherever contacts begin after none.

Frames of Blender have the numbers by which the answer names them. The script prints what it made as one line of JSON. Needs Blender 3.4 or later.
"""
import argparse
import json
import pathlib
import sys

import bpy


def arguments():
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="cscd_contacts.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=pathlib.Path)
    parser.add_argument("cache", type=pathlib.Path)
    parser.add_argument("answer", type=pathlib.Path)
    parser.add_argument("--save", type=pathlib.Path, help="the .blend file to write")
    parser.add_argument("--still", type=pathlib.Path, help="a picture of the first contact to render, .png")
    return parser.parse_args(words)


def refuse(text):
    print(f"cscd_contacts.py: {text}", file=sys.stderr)
    sys.exit(2)


def read_mesh(path):
    """The surface with its vertices in the order of the file, and its axes as they are, so that it fits its cache."""
    vertices, faces = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            numbers = [int(word.split("/")[0]) for word in words[1:]]
            faces.append([n - 1 if n > 0 else len(vertices) + n for n in numbers])
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(vertices, [], faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    return bpy.data.objects.new(path.stem, mesh)


def material(name, colour):
    made = bpy.data.materials.new(name)
    made.diffuse_color = (*colour, 1)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1)
    return made


def add_cache(surface, path, first):
    modifier = surface.modifiers.new("cache", "MESH_CACHE")
    modifier.cache_format = "PC2" if path.suffix.lower() == ".pc2" else "MDD"
    modifier.filepath = str(path.resolve())
    modifier.frame_start = first
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"  # as they are


def mark_touching(surface, intervals):
    touching = sorted({v for interval in intervals for contact in interval["contacts"] for v in contact["vertices"]})
    if touching and touching[-1] >= len(surface.data.vertices):
        refuse("the answer names vertices that the mesh does not have; ask cscd query about the cache that belongs to it")
    surface.vertex_groups.new(name="touching").add(touching, 1.0, "REPLACE")
    return len(touching)


def add_points(interval, collection, look, size):
    """A cloud that is shown in one frame alone: an octahedron for each contact, as a vertex by itself is not rendered."""
    corners = [(size, 0, 0), (-size, 0, 0), (0, size, 0), (0, -size, 0), (0, 0, size), (0, 0, -size)]
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    vertices, faces = [], []
    for contact in interval["contacts"]:
        faces += [[len(vertices) + corner for corner in triangle] for triangle in triangles]
        vertices += [[x + d for x, d in zip(contact["point"], corner)] for corner in corners]
    mesh = bpy.data.meshes.new(f"contacts {interval['index']}")
    mesh.from_pydata(vertices, [], faces)
    mesh.materials.append(look)
    cloud = bpy.data.objects.new(mesh.name, mesh)
    cloud["contacts"] = len(interval["contacts"])
    collection.objects.link(cloud)
    frame = interval["frame"]
    for at, hidden in ((frame - 1, True), (frame, False), (frame + 1, True)):
        cloud.hide_viewport = cloud.hide_render = hidden
        cloud.keyframe_insert("hide_viewport", frame=at)
        cloud.keyframe_insert("hide_render", frame=at)


def add_markers(scene, intervals, worst_frame):
    before = None
    for interval in intervals:
        if before is None or interval["index"] > before + 1:
            scene.timeline_markers.new("first contact" if before is None else "contact", frame=interval["frame"])
        before = interval["index"]
    if worst_frame is not None:
        scene.timeline_markers.new("worst", frame=worst_frame)


def render(scene, surface, interval, path):
    """A still of the first contact, from the side of the surface that its normal leaves free."""
    from mathutils import Vector

    contact = interval["contacts"][0]
    point = Vector(contact["point"])
    reach = max(surface.dimensions)
    towards = Vector(contact["normal"] or (0, 0, 1)).orthogonal().normalized()
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = point + towards * reach * 0.8
    camera.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
    camera.data.clip_end = 10 * reach
    scene.collection.objects.link(camera)
    scene.camera = camera
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 2.5
    sun.rotation_euler = (towards + Vector((0.6, 0.8, 0.3))).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(sun)
    scene.frame_set(interval["frame"])
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 32
    scene.cycles.use_denoising = False  # not in every build
    scene.render.resolution_x, scene.render.resolution_y = 480, 360
    scene.world = scene.world or bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.3, 0.33, 0.36, 1)
    scene.render.filepath = str(path.resolve())
    bpy.ops.render.render(write_still=True)


def main():
    chosen = arguments()
    for path in (chosen.mesh, chosen.cache, chosen.answer):
        if not path.exists():
            refuse(f"{path}: no such file; check the name")
    answer = json.loads(chosen.answer.read_text())
    if answer.get("schema") != "cscd.query/4" or "intervals" not in answer:
        refuse(f"{chosen.answer}: is no answer about one clip; write it with cscd query INPUT --clip NAME --json FILE")
    first = round(answer["import"]["clips"][0]["first_frame"])
    for interval in answer["intervals"]:
        interval["frame"] = first + interval["index"]  # Blender's frames are whole numbers
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    surface = read_mesh(chosen.mesh)
    scene.collection.objects.link(surface)
    surface.data.materials.append(material("surface", (0.6, 0.66, 0.7)))
    add_cache(surface, chosen.cache, first)
    touching = [interval for interval in answer["intervals"] if interval["contacts"]]
    vertices = mark_touching(surface, touching)
    collection = bpy.data.collections.new("contacts")
    scene.collection.children.link(collection)
    look = material("contacts", (0.84, 0.2, 0.0))
    for interval in touching:
        add_points(interval, collection, look, 0.004 * max(surface.dimensions))
    worst = answer["summary"]["worst"]
    add_markers(scene, touching, worst and first + worst["interval"])
    scene.frame_start, scene.frame_end = first, answer["intervals"][-1]["frame"] + 1
    if chosen.still and touching:
        render(scene, surface, touching[0], chosen.still)
    scene.frame_set((touching or answer["intervals"])[0]["frame"])
    moved = surface.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices
    if chosen.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(chosen.save.resolve()))
    print(json.dumps({
        "clouds": len(collection.objects), "contacts": sum(cloud["contacts"] for cloud in collection.objects),
        "touching_vertices": vertices, "markers": len(scene.timeline_markers), "vertices": len(surface.data.vertices),
        "first_vertex": list(moved[0].co), "frames": scene.frame_end}))


main()
