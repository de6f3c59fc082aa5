// What is drawn flat on the finished picture: contact marks, triad, scale bar, caption.
#pragma once

#include "render/stage.h"
#include "render/text.h"

namespace aircut::render {

/// `stage.view` must have the size of the picture.
void draw_overlay(Image& image, const Scene& scene, const Stage& stage, const Fonts& fonts);
/// Pixels per unit of the layout: 1 for a picture of 1280 x 800.
double layout_scale(int width, int height);

}  // namespace aircut::render
