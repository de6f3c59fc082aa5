// guides: the same as on the crossed form.
include <../../ox-glide-crossed/scad/guides.scad>
