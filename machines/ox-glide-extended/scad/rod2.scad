// rod2: the same as on the crossed form.
include <../../ox-glide-crossed/scad/rod2.scad>
