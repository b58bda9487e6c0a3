"""Arms (`*.urdf`), end effectors (`tools/*.urdf`) and their meshes; `build` makes them all."""
