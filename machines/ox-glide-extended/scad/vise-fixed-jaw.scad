// vise-fixed-jaw: the same as on the crossed form.
include <../../ox-glide-crossed/scad/vise-fixed-jaw.scad>
