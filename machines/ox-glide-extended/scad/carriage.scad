// carriage: the same as on the crossed form.
include <../../ox-glide-crossed/scad/carriage.scad>
