// Two jaws that close on the dovetail under the raw part.
include <params.scad>

for (s = [0, 1]) mirror([s, 0, 0])
profile_xz([[14, 69], [30, 69], [34, 73], [34, 80], [22, 80], [17, 74], [14, 74]], -26, 26);
