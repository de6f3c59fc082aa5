// Platform of the crossed form, with the pin of the parallel link on the right of that of rod 1.
include <../../ox-glide-crossed/scad/platform.scad>

par = [30, 60];
