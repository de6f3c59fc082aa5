// Slider 1: the mirror image of that of the crossed form, because the parallel link is on the right of
// rod 1 here.
module crossed_form() {
  include <../../ox-glide-crossed/scad/slider1.scad>
}
mirror([1, 0, 0]) crossed_form();
