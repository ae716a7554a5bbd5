# FreeCAD runs this file when it starts, without a window too. What the module can do is in octafront_fem.
