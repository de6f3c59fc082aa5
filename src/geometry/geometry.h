// geometry: poses, boxes, triangle meshes and revolved profiles, and the reader of mesh files.
// Lengths are mm, angles rad. Third-party mesh importers stay inside this library.
#pragma once

#include "geometry/axis_values.h"
#include "geometry/mesh.h"
#include "geometry/mesh_file.h"
#include "geometry/pose.h"
#include "geometry/profile.h"
