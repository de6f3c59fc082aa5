// spindle: the same as on the crossed form.
include <../../ox-glide-crossed/scad/spindle.scad>
