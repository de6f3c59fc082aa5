// vise-screw: the same as on the crossed form.
include <../../ox-glide-crossed/scad/vise-screw.scad>
