"""Pictures of surfaces without a 3D library: triangles are painted from back to front."""
import numpy as np
from matplotlib.collections import PolyCollection

AMBIENT = 0.35


def view_axes(azimuth, elevation):
    """Right, up and towards the viewer, for a view from that direction in degrees."""
    a, e = np.radians(azimuth), np.radians(elevation)
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return right, np.cross(towards, right), towards


def broad_side(positions, near):
    """Axes of a view along the direction in which the surface is thinnest, its longest direction upright, from the side that
    is nearer to another view."""
    _, _, axes = np.linalg.svd(positions - positions.mean(axis=0), full_matrices=False)
    up = axes[0] * (1 if axes[0][np.argmax(np.abs(axes[0]))] > 0 else -1)
    towards = axes[2] * (1 if axes[2] @ near[2] > 0 else -1)
    return np.cross(up, towards), up, towards


def normals_of(positions, triangles):
    corners = positions[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def shaded(positions, triangles, colours, view):
    """The colours of the triangles under a light from above, over the viewer's left shoulder."""
    right, up, towards = view
    light = -0.4 * right + 0.7 * up + 0.6 * towards
    bright = AMBIENT + (1 - AMBIENT) * np.clip(normals_of(positions, triangles) @ (light / np.linalg.norm(light)), 0, 1)
    return colours * bright[:, None]


def paint(axes, positions, triangles, colours, view):
    """Paints the triangles that face the viewer."""
    right, up, towards = view
    drawn = normals_of(positions, triangles) @ towards > 0
    polygons, fill = positions[triangles][drawn], colours[drawn]
    order = np.argsort(polygons.mean(axis=1) @ towards, kind="stable")
    flat = np.stack([polygons @ right, polygons @ up], axis=2)
    axes.add_collection(PolyCollection(flat[order], facecolors=fill[order], edgecolors=fill[order], linewidths=0.15))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")
