# SPDX-License-Identifier: BSD-3-Clause
# blender --background --factory-startup --python blender.py -- MAP.obj|MAP.glb PICTURE.png WIDTH HEIGHT
# Imports a map with Blender's own importer and renders what it made of it, colours as they came with the file.
import sys

import bpy
import numpy
from mathutils import Vector

source, picture, width, height = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
if source.lower().endswith(".obj"):
    bpy.ops.wm.obj_import(filepath=source, forward_axis="Y", up_axis="Z")
else:
    if "bool" not in vars(numpy):  # Debian 12's Blender 3.4 asks its numpy for a name that is gone
        numpy.bool = bool
    bpy.ops.import_scene.gltf(filepath=source)

meshes = [o for o in bpy.context.scene.objects if o.type == "MESH"]
for o in meshes:
    print(o.name, len(o.data.vertices), "vertices,", len(o.data.edges), "edges,", len(o.data.polygons), "faces,",
          [a.name for a in o.data.color_attributes])

# the middle of what is there, without the few lines that run away
corners = [sorted((o.matrix_world @ v.co)[k] for o in meshes if o.name.startswith("Lines") for v in o.data.vertices)
           for k in range(3)]
low = Vector([c[len(c) // 10] for c in corners])
high = Vector([c[len(c) * 9 // 10] for c in corners])
centre, size = (low + high) / 2, (high - low).length

camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.data.clip_start, camera.data.clip_end = size / 100, size * 100
camera.location = centre + Vector((-0.7, -1.1, 1.1)) * size
camera.rotation_euler = (centre - camera.location).to_track_quat("-Z", "Y").to_euler()
bpy.context.collection.objects.link(camera)

# Colours as they are, without light and its noise.
for material in bpy.data.materials:
    shader = material.node_tree.nodes.get("Principled BSDF") if material.use_nodes else None
    if shader is None:
        continue
    base, glow = shader.inputs["Base Color"], shader.inputs["Emission"]
    glow.default_value = base.default_value
    for link in base.links:
        material.node_tree.links.new(link.from_socket, glow)
    base.default_value = (0, 0, 0, 1)

scene = bpy.context.scene
scene.camera = camera
scene.world = bpy.data.worlds.new("World")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.02, 0.02, 0.02, 1)
scene.view_settings.view_transform = "Standard"
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 8
scene.cycles.use_denoising = False
scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
scene.render.dither_intensity = 0
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
