// Way cover in front of the saddle: a rigid roof over the Y rails that moves with the saddle.
include <params.scad>

difference() {
  profile_xz([[-330, way_z + 20], [-330, way_z + 44], [-20, way_z + 70], [20, way_z + 70], [330, way_z + 44],
              [330, way_z + 20]], -470, -206);
  profile_xz([[-326, way_z + 10], [-326, way_z + 40], [-20, way_z + 66], [20, way_z + 66], [326, way_z + 40],
              [326, way_z + 10]], -480, -190);
}
// wiper lip
profile_xz([[-332, way_z + 18], [-332, way_z + 46], [-20, way_z + 72], [20, way_z + 72], [332, way_z + 46],
            [332, way_z + 18], [326, way_z + 18], [326, way_z + 40], [20, way_z + 66], [-20, way_z + 66],
            [-326, way_z + 40], [-326, way_z + 18]], -476, -468);
