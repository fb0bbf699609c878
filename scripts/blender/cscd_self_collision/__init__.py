"""The add-on: reads meshes as Blender shows them, asks the Python module cscd, and shows the answer. README.md beside this folder."""
import concurrent.futures
import functools
import json
import math
import pathlib
import time

import bpy
import numpy as np
from bpy_extras.io_utils import ImportHelper, axis_conversion
from mathutils import Quaternion, Vector

from . import events as ev

bl_info = {
    "name": "Self-collision (cscd)",
    "description": "Finds where a moving surface lies in itself or touches itself, how deep and when",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > Self-collision",
    "category": "Animation",
}
NAME = "Self-collision"  # of the vertex group, the collection and its objects
OURS = "cscd_self_collision"  # the property that marks what the add-on has made
HOW_TO_GET_IT = ("The Python module cscd is not installed: build it as library/README.md says under Python, and put it where "
                 "Blender's Python finds it (PYTHONPATH).")
MOST_SHOWN = 30  # events that get a marker and curves


@functools.lru_cache
def module():
    """Returns the Python module cscd, or None where it is not installed."""
    try:
        import cscd
    except ImportError:
        return None
    return cscd


class Stop(Exception):
    """What a check ends with, as a sentence for the user."""


class Reader:
    """Reads objects as the scene shows them in a frame: modifiers applied, in world space, in triangles."""

    def __init__(self, context, objects):
        self.scene, self.objects = context.scene, objects
        self._loops = [None] * len(objects)

    def at_rest(self):
        """Reads triangles, names and bones, and returns the pose at rest: that of the armatures, in the first frame."""
        armatures = {a.data for a in (o.find_armature() for o in self.objects) if a}
        before = {data: data.pose_position for data in armatures}
        try:
            for data in armatures:
                data.pose_position = "REST"
            self._read_bones()
            rows = list(self._meshes(frames_of(self.scene)[0], self._read_surface))
        finally:
            for data, position in before.items():
                data.pose_position = position
        self.counts = [len(positions) for positions, _ in rows]
        starts = np.cumsum([0, *self.counts[:-1]])
        self.triangles = np.concatenate([read[0] + start for start, (_, read) in zip(starts, rows)])
        self.owner = np.repeat(np.arange(len(rows)), [len(read[0]) for _, read in rows])
        self.bone = np.concatenate([read[1] for _, read in rows])
        return np.concatenate([positions for positions, _ in rows])

    def pose(self, frame):
        return np.concatenate([positions for positions, _ in self._meshes(frame, lambda *_: None)])

    def surface(self, poses):
        return ev.Surface(poses, self.triangles, self.owner, [o.name for o in self.objects], self.bone, self.bone_names, self.parents)

    def _meshes(self, frame, read):
        self.scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for i, thing in enumerate(self.objects):
            shown = thing.evaluated_get(graph)
            mesh = shown.to_mesh()
            try:
                loops = np.empty(len(mesh.loops), np.int32)
                mesh.loops.foreach_get("vertex_index", loops)
                if self._loops[i] is None:
                    self._loops[i] = loops
                elif not np.array_equal(loops, self._loops[i]):
                    raise Stop(f"{thing.name} has other faces at frame {frame} than before; switch off the modifier that changes them")
                positions = np.empty(3 * len(mesh.vertices), np.float32)
                mesh.vertices.foreach_get("co", positions)
                world = np.array(shown.matrix_world)
                yield positions.reshape(-1, 3).astype(float) @ world[:3, :3].T + world[:3, 3], read(thing, mesh)
            finally:
                shown.to_mesh_clear()

    def _read_surface(self, thing, mesh):
        mesh.calc_loop_triangles()
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        armature = thing.find_armature()
        of_group = {g.index: self.bones.get((armature, g.name)) for g in thing.vertex_groups} if armature else {}
        bone = np.full(len(mesh.vertices), -1)
        for v in mesh.vertices if of_group else ():
            weights = [(g.weight, -of_group[g.group]) for g in v.groups if of_group.get(g.group) is not None and g.weight > 0]
            if weights:
                bone[v.index] = -max(weights)[1]
        mirrored = thing.matrix_world.determinant() < 0
        return triangles.reshape(-1, 3)[:, ::-1 if mirrored else 1], bone

    def _read_bones(self):
        """Numbers the bones that have vertex groups, each with the nearest of them above it."""
        groups = {}
        for thing in self.objects:
            if armature := thing.find_armature():
                groups.setdefault(armature, set()).update(g.name for g in thing.vertex_groups)
        used = [(a, b) for a, names in groups.items() for b in a.data.bones if b.use_deform and b.name in names]
        self.bones = {(a, b.name): i for i, (a, b) in enumerate(used)}
        self.parents = [next((self.bones[a, p.name] for p in b.parent_recursive if (a, p.name) in self.bones), -1) for a, b in used]
        twice = len({b.name for _, b in used}) < len(used)
        self.bone_names = [f"{a.name}/{b.name}" if twice else b.name for a, b in used]


def frames_of(scene):
    return (scene.frame_preview_start, scene.frame_preview_end) if scene.use_preview_range else (scene.frame_start, scene.frame_end)


def meshes_of(context):
    """The selected meshes, and the visible meshes that selected armatures move or carry."""
    chosen = set(context.selected_objects)
    return [o for o in context.visible_objects if o.type == "MESH" and chosen & {o, o.find_armature(), o.parent}]


def length_in(scene):
    unit = scene.unit_settings
    return lambda length: bpy.utils.units.to_string(unit.system, "LENGTH", length * unit.scale_length, precision=3).strip()


class Result:
    """What the last check or answer found, for what is shown of it to be made anew. Scene and objects by name: undo replaces them."""
    scene = events = weights = None  # weights: a function of events that returns those of all vertices, object after object
    objects, counts, frames, thickness = (), (), (0, 0), 0.0


@bpy.app.handlers.persistent
def forget_result(*_):
    """A file that is opened has other scenes and objects."""
    Result.scene = None


def checking(context, cscd, settings):
    """A check as a generator: yields how much is done and a function to call elsewhere, and takes what that returns."""
    scene, now = context.scene, context.scene.frame_current
    objects = meshes_of(context)
    if not objects:
        raise Stop("Select a mesh, or the armature that moves it.")
    try:
        reader = Reader(context, objects)
        first, last = frames_of(scene)
        poses = [reader.at_rest()]
        if not len(reader.triangles):
            raise Stop("What is selected has no faces.")
        wanted = settings.thickness, not settings.count_rest
        while True:
            surface = reader.surface(poses)
            check = yield 0.0, lambda: ev.Check(cscd, surface, poses[0], *wanted)
            for frame in range(first, last + 1):
                pose = reader.pose(frame)
                if surface.parts_in(pose):  # begin anew with vertices that are one at rest and part here
                    poses.append(pose)
                    break
                yield (frame - first) / (last - first + 1), lambda: check.add(frame, pose)
            else:
                break
        Result.scene, Result.events, Result.frames, Result.thickness = scene.name, check.events(), (first, last), check.thickness
        Result.objects, Result.counts = [o.name for o in objects], reader.counts
        Result.weights = lambda events: check.weights(events, len(poses[0]))
        settings.note = "What crosses at rest is left out." if len(check.rest) else ""
    finally:
        scene.frame_set(now)


def forget(scene):
    """Removes what the add-on has made in a scene."""
    for marker in [m for m in scene.timeline_markers if m.get(OURS)]:
        scene.timeline_markers.remove(marker)
    for thing in list(scene.objects):
        if thing.get(OURS):
            bpy.data.curves.remove(thing.data)  # and with it the object
        elif thing.type == "MESH" and not thing.library and (group := thing.vertex_groups.get(NAME)):
            thing.vertex_groups.remove(group)
    for collection in [c for c in scene.collection.children if c.get(OURS)]:
        bpy.data.collections.remove(collection)


def show(scene):
    """Makes markers, curves, weights and the list of what the last result holds and the settings do not leave out."""
    settings = scene.cscd_self_collision
    ignored = {frozenset((pair.first, pair.second)) for pair in settings.ignored}
    found = [e for e in Result.events if frozenset(e.names) not in ignored]
    length = length_in(scene)
    settings.headline = ev.headline(found, length, Result.frames, Result.thickness)
    settings.folds = sum(e.at_joint for e in found)
    shown = [e for e in found if settings.count_folds or not e.at_joint]
    forget(scene)
    settings.rows.clear()
    size = max((max(o.dimensions) for o in map(scene.objects.get, Result.objects) if o), default=1.0)
    for event in shown:
        row = settings.rows.add()
        row.name, row.sentence = ev.title(event, length), ev.sentence(event, length, Result.thickness)
        row.first, row.second = event.names
        row.depth = length(event.depth) if event.depth > 0 else ""
        row.frame, row.point = math.floor(event.deepest + 0.005), event.point
        if event.lines and (event.depth > 0 or event.touches):
            row.out = event.lines[-1][1] - event.lines[-1][0]
        row.reach = max(8 * event.depth, 0.3 * size)
    if shown:
        collection = bpy.data.collections.new(NAME)
        collection[OURS] = True
        scene.collection.children.link(collection)
    for event, row in list(zip(shown, settings.rows))[:MOST_SHOWN]:
        scene.timeline_markers.new(row.name, frame=row.frame)[OURS] = True
        if event.lines:
            extent = max(np.ptp(np.concatenate(event.lines), axis=0))
            collection.objects.link(curves(row, event.lines, min(0.05 * extent, 0.002 * size)))
    if shown and Result.weights:
        add_weights(Result.weights(shown))


def curves(row, lines, radius):
    """Makes an object of polylines that is shown in the row's frame, in front of everything."""
    data = bpy.data.curves.new(row.name, "CURVE")
    data.dimensions, data.bevel_depth = "3D", radius
    for line in lines:
        spline = data.splines.new("POLY")
        spline.points.add(len(line) - 1)
        spline.points.foreach_set("co", np.column_stack([line, np.ones(len(line))]).ravel())
    look = bpy.data.materials.get(NAME) or bpy.data.materials.new(NAME)
    look.diffuse_color = (0.9, 0.15, 0.0, 1.0)
    data.materials.append(look)
    made = bpy.data.objects.new(row.name, data)
    made[OURS], made.show_in_front, made.color = True, True, look.diffuse_color
    for hidden in ("hide_viewport", "hide_render"):
        made.driver_add(hidden).driver.expression = f"frame != {row.frame}"
    return made


def add_weights(weights):
    start = 0
    for name, count in zip(Result.objects, Result.counts):
        own, start, thing = weights[start:start + count], start + count, bpy.data.objects.get(name)
        if not thing or count != len(thing.data.vertices) or thing.library or thing.mode == "EDIT":
            continue  # modifiers make other vertices than those that a group can hold
        group = thing.vertex_groups.get(NAME) or thing.vertex_groups.new(name=NAME)  # objects may share a mesh
        for v in np.flatnonzero(own).tolist():
            group.add([v], own[v], "REPLACE")


def jump(settings, context):
    """Goes to the frame of the row that is clicked, and turns all 3D views to its point, seen from above where the way out leads."""
    if not 0 <= settings.active < len(settings.rows):
        return
    row = settings.rows[settings.active]
    context.scene.frame_set(row.frame)
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                view = area.spaces.active.region_3d
                if view.view_perspective == "CAMERA":
                    view.view_perspective = "PERSP"
                view.view_location, view.view_distance = row.point, row.reach
                if any(row.out):
                    view.view_rotation = Vector(row.out).to_track_quat("Z", "Y") @ Quaternion((1, 0, 0), -0.5)


def show_again(settings, context):
    if Result.scene == context.scene.name:
        show(context.scene)


class Row(bpy.types.PropertyGroup):
    depth: bpy.props.StringProperty()
    sentence: bpy.props.StringProperty()
    first: bpy.props.StringProperty()
    second: bpy.props.StringProperty()
    frame: bpy.props.IntProperty()
    point: bpy.props.FloatVectorProperty()
    out: bpy.props.FloatVectorProperty()  # the way out, or the direction of a touch
    reach: bpy.props.FloatProperty()


class Settings(bpy.types.PropertyGroup):
    thickness: bpy.props.FloatProperty(
        name="Thickness", unit="LENGTH", min=0.0, precision=4, step=0.1,
        description="What comes nearer than this counts as a touch, apart from what is that near at rest; 0 is touching")
    count_rest: bpy.props.BoolProperty(
        name="Crossings at rest, too", default=False,
        description="Count eyes in sockets, teeth in gums, clothes in skin: what crosses where the armature is in its rest position")
    count_folds: bpy.props.BoolProperty(
        name="Folds at joints, too", default=False, update=show_again,
        description="List what neighbouring bones do to each other less deep than a tenth of the limb's girth")
    headline: bpy.props.StringProperty()
    note: bpy.props.StringProperty()
    folds: bpy.props.IntProperty()
    rows: bpy.props.CollectionProperty(type=Row)
    active: bpy.props.IntProperty(update=jump)
    ignored: bpy.props.CollectionProperty(type=Row)
    done: bpy.props.FloatProperty(name="Done", subtype="PERCENTAGE", min=0, max=100, precision=0)
    running: bpy.props.BoolProperty(options={"SKIP_SAVE"})


class Check(bpy.types.Operator):
    """Check the selected meshes, or those of the selected armature, over the frame range of the scene"""
    bl_idname = "cscd_self_collision.check"
    bl_label = "Check"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        return module() is not None and not context.mode.startswith("EDIT") and not context.scene.cscd_self_collision.running

    def execute(self, context):
        """Checks at once, for scripts."""
        steps = checking(context, module(), context.scene.cscd_self_collision)
        try:
            job = next(steps)[1]
            while True:
                job = steps.send(job())[1]
        except StopIteration:
            show(context.scene)
            return {"FINISHED"}
        except (Stop, ValueError, MemoryError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    def invoke(self, context, event):
        """Checks beside the user's work: Blender reads a frame while another thread answers the one before."""
        settings = context.scene.cscd_self_collision
        settings.running, settings.done = True, 0
        self.steps = checking(context, module(), settings)
        self.worker = concurrent.futures.ThreadPoolExecutor(max_workers=1)
        self.answer = None
        self.timer = context.window_manager.event_timer_add(0.02, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        settings = context.scene.cscd_self_collision
        if event.type == "ESC" or not settings.running:
            return self.end(context, "Cancelled.")
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        until = time.monotonic() + 0.1  # each pass draws all windows anew
        try:
            while (left := until - time.monotonic()) > 0:
                share, job = self.steps.send(self.answer and self.answer.result(left))
                self.answer = self.worker.submit(job)
                settings.done = 100 * share
        except concurrent.futures.TimeoutError:
            pass
        except StopIteration:
            return self.end(context)
        except ReferenceError:
            return self.end(context, "The scene was changed while it was checked. Check again.")
        except (Stop, ValueError, MemoryError) as error:
            return self.end(context, str(error))
        redraw(context)
        return {"PASS_THROUGH"}

    def end(self, context, why=""):
        self.steps.close()
        self.worker.shutdown(wait=False, cancel_futures=True)
        context.window_manager.event_timer_remove(self.timer)
        context.scene.cscd_self_collision.running = False
        if why:
            self.report({"WARNING"}, why)
        else:
            show(context.scene)
            context.scene.cscd_self_collision.active = 0  # goes to the deepest, as a click on its row does
        redraw(context)
        return {"CANCELLED"} if why else {"FINISHED"}


def redraw(context):
    for area in context.screen.areas if context.screen else ():
        area.tag_redraw()


class Cancel(bpy.types.Operator):
    """End the check that is going on"""
    bl_idname = "cscd_self_collision.cancel"
    bl_label = "Cancel"

    def execute(self, context):
        context.scene.cscd_self_collision.running = False
        return {"FINISHED"}


class Ignore(bpy.types.Operator):
    """Leave out what these two places do to each other"""
    bl_idname = "cscd_self_collision.ignore"
    bl_label = "Ignore this pair"
    bl_options = {"UNDO"}
    row: bpy.props.IntProperty()

    def execute(self, context):
        settings = context.scene.cscd_self_collision
        row = settings.rows[self.row]
        pair = settings.ignored.add()
        pair.first, pair.second = row.first, row.second
        show_again(settings, context)
        return {"FINISHED"}


class Heed(bpy.types.Operator):
    """Count this pair again"""
    bl_idname = "cscd_self_collision.heed"
    bl_label = "Count this pair again"
    bl_options = {"UNDO"}
    pair: bpy.props.IntProperty()

    def execute(self, context):
        settings = context.scene.cscd_self_collision
        settings.ignored.remove(self.pair)
        show_again(settings, context)
        return {"FINISHED"}


class Clear(bpy.types.Operator):
    """Remove markers, curves, weights and list"""
    bl_idname = "cscd_self_collision.clear"
    bl_label = "Clear"
    bl_options = {"UNDO"}

    def execute(self, context):
        settings = context.scene.cscd_self_collision
        forget(context.scene)
        settings.rows.clear()
        settings.headline = settings.note = ""
        settings.folds = 0
        Result.scene = None
        return {"FINISHED"}


def follow_cache(cache, up, frame, rate):
    """Imports the mesh beside a mesh cache, turned so that z is up, and lets it follow the cache from a frame on."""
    bpy.ops.wm.obj_import(filepath=str(cache.with_suffix(".obj")), up_axis=up.replace("-", "NEGATIVE_"),
                          forward_axis="NEGATIVE_Z" if "Y" in up else "Y")
    surface = bpy.context.object
    follow = surface.modifiers.new("Cache", "MESH_CACHE")
    follow.cache_format, follow.filepath = cache.suffix[1:].upper(), str(cache.resolve())
    follow.frame_start, follow.frame_scale = frame, rate
    follow.forward_axis, follow.up_axis = "POS_Y", "POS_Z"  # as they are: the object is turned
    return surface


class LoadAnswer(bpy.types.Operator, ImportHelper):
    """Show an answer of cscd query --json about a model that this scene holds, or about a mesh cache, which is loaded with it"""
    bl_idname = "cscd_self_collision.load"
    bl_label = "Load an answer of cscd query"
    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})
    up: bpy.props.EnumProperty(name="Up", items=[(a, a, "") for a in ("FILE", "X", "Y", "Z", "-X", "-Y", "-Z")],
                               description="The axis that points up in the answer; FILE is what the answer says, or else Y")

    def execute(self, context):
        path = pathlib.Path(self.filepath)
        scene = context.scene
        try:
            answer = json.loads(path.read_text())
            told = (isinstance(answer, dict) and answer.get("import")) or {}
            up = (told.get("up") or "y").upper() if self.up == "FILE" else self.up
            scale = (told.get("centimetres_per_unit") or 100) / 100 / scene.unit_settings.scale_length
            found = ev.from_answer(answer, scale * np.array(axis_conversion(from_forward="-Z" if "Y" in up else "Y", from_up=up)))
        except (OSError, ValueError, KeyError) as error:
            self.report({"ERROR"}, f"{path.name}: {error}")
            return {"CANCELLED"}
        rate = scene.render.fps / scene.render.fps_base / (told.get("fps") or scene.render.fps)
        begin = 1 if told.get("format", "").lower().startswith("fbx") else 0  # Blender's importers put time 0 there
        for event in found:
            event.begins, event.ends, event.deepest = (begin + rate * f for f in (event.begins, event.ends, event.deepest))
        Result.scene, Result.events, Result.weights = scene.name, found, None
        Result.thickness = scale * answer.get("thickness", {}).get("length", 0.0)
        Result.frames = tuple(begin + rate * interval["frame"] for interval in (answer["intervals"][0], answer["intervals"][-1]))
        Result.objects = [o.name for o in meshes_of(context)]
        cache = path.parent / answer["input"]
        if cache.suffix in (".pc2", ".mdd") and cache.with_suffix(".obj").exists() and told.get("clips"):
            surface = follow_cache(cache, up, round(begin + rate * told["clips"][0]["first_frame"]), rate)
            Result.objects, Result.counts = [surface.name], [len(surface.data.vertices)]
            Result.weights = lambda events: ev.weights(events, Result.counts[0])
        scene.cscd_self_collision.note = f"From {path.name}."
        show(scene)
        return {"FINISHED"}


class Rows(bpy.types.UIList):
    bl_idname = "CSCD_UL_rows"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0, flag=0):
        column = layout.column(align=True)
        line = column.row(align=True)
        line.label(text=item.name.partition(":")[0])
        line.operator(Ignore.bl_idname, text="", icon="HIDE_ON", emboss=False).row = index
        line = column.row()
        line.active = False
        line.label(text=", ".join(filter(None, (item.depth, f"frame {item.frame}"))))


def write(layout, context, text, icon="NONE"):
    """Labels of a text, with line breaks where the sidebar ends."""
    wide = max(16, int(context.region.width / (7 * context.preferences.system.ui_scale)) - (4 if icon == "NONE" else 7))
    line, column = "", layout.column(align=True)
    for word in [*text.split(), None]:
        if line and (word is None or len(line) + len(word) >= wide):
            column.label(text=line, icon=icon)
            line, icon = "", "BLANK1" if icon != "NONE" else icon
        line = f"{line} {word}".strip()


class Panel(bpy.types.Panel):
    bl_label = "Self-collision"
    bl_idname = "CSCD_PT_self_collision"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Self-collision"

    def draw(self, context):
        layout, settings = self.layout, context.scene.cscd_self_collision
        layout.use_property_split, layout.use_property_decorate = True, False
        if module() is None:
            write(layout, context, HOW_TO_GET_IT, "ERROR")
        if settings.running:
            line = layout.row(align=True)
            line.use_property_split = False
            line.prop(settings, "done", slider=True)
            line.operator(Cancel.bl_idname, text="", icon="X")
        else:
            layout.operator(Check.bl_idname, icon="VIEWZOOM")
        column = layout.column()
        column.enabled = not settings.running
        column.prop(settings, "thickness")
        column.use_property_split = False
        column.prop(settings, "count_rest")
        column.prop(settings, "count_folds")
        if settings.headline:
            write(layout.box(), context, settings.headline)
        if settings.rows:
            layout.template_list(Rows.bl_idname, "", settings, "rows", settings, "active", rows=4)
            if 0 < settings.active < len(settings.rows):  # the headline says the first
                write(layout, context, settings.rows[settings.active].sentence)
        if settings.folds and not settings.count_folds:
            write(layout, context, f"{settings.folds} fold{'s' if settings.folds > 1 else ''} at joints not listed")
        if settings.note:
            write(layout, context, settings.note)
        for i, pair in enumerate(settings.ignored):
            line = layout.row(align=True)
            line.label(text=f"Ignored: {pair.first}, {pair.second}")
            line.operator(Heed.bl_idname, text="", icon="X", emboss=False).pair = i
        line = layout.column(align=True)
        line.enabled = not settings.running
        line.operator(LoadAnswer.bl_idname, text="Load answer", icon="FILE_FOLDER")
        line.operator(Clear.bl_idname, icon="TRASH")


CLASSES = (Row, Settings, Check, Cancel, Ignore, Heed, Clear, LoadAnswer, Rows, Panel)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.cscd_self_collision = bpy.props.PointerProperty(type=Settings)
    bpy.app.handlers.load_post.append(forget_result)


def unregister():
    bpy.app.handlers.load_post.remove(forget_result)
    del bpy.types.Scene.cscd_self_collision
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
