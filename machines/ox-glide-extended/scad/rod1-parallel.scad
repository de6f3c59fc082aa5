// Parallel link of rod 1, on the right of it: on the left, as in the crossed form, the leaning rods
// would touch each other.
include <../../ox-glide-crossed/scad/rod1-parallel.scad>

par = [30, 60];
