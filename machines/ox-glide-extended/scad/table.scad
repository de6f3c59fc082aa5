// Table: that of the crossed form, 14 lower, because the platform does not rise as high here.
include <../../ox-glide-crossed/scad/table.scad>

table_z = -574;
