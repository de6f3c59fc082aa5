// rod1: the same as on the crossed form.
include <../../ox-glide-crossed/scad/rod1.scad>
