// frame-ways: the same as on the crossed form.
include <../../ox-glide-crossed/scad/frame-ways.scad>
