// vise-base: the same as on the crossed form.
include <../../ox-glide-crossed/scad/vise-base.scad>
