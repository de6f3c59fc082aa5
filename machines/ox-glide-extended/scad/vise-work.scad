// vise-work: the same as on the crossed form.
include <../../ox-glide-crossed/scad/vise-work.scad>
