// frame: the same as on the crossed form.
include <../../ox-glide-crossed/scad/frame.scad>
