// slider2: the same as on the crossed form.
include <../../ox-glide-crossed/scad/slider2.scad>
