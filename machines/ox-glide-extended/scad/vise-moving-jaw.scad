// vise-moving-jaw: the same as on the crossed form.
include <../../ox-glide-crossed/scad/vise-moving-jaw.scad>
