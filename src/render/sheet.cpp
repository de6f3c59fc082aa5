// Contact sheet: pictures in a grid, each with a line of text under it.
#include <algorithm>
#include <cmath>

#include "render/text.h"

namespace aircut::render {
namespace {

constexpr Ink paper{244, 245, 247, 1};
constexpr Ink card{255, 255, 255, 1};
constexpr Ink dark{32, 38, 48, 1};

struct SheetLayout {
  int columns = 1, rows = 1;
  int cell_width = 0, picture_height = 0, caption_height = 0;
  int gap = 0, head = 0;
  int text = 0, title = 0;

  int width() const { return columns * cell_width + (columns + 1) * gap; }
  int height() const { return head + rows * (picture_height + caption_height) + (rows + 1) * gap; }
};

SheetLayout lay_out(const std::vector<SheetCell>& cells, int columns, int cell_width,
                    bool has_title) {
  SheetLayout out;
  const int count = static_cast<int>(cells.size());
  out.columns = std::clamp(columns, 1, std::max(count, 1));
  out.rows = (count + out.columns - 1) / out.columns;
  out.cell_width = std::clamp(cell_width, 16, 4096);
  out.text = std::clamp(out.cell_width / 32, 9, 28);
  out.title = out.text + out.text / 2;
  out.gap = std::max(6, out.cell_width / 32);
  out.caption_height = 2 * out.text;
  out.head = has_title ? out.gap + out.title * 3 / 2 : 0;
  for (const SheetCell& cell : cells)
    if (cell.image.width > 0)
      out.picture_height = std::max(
          out.picture_height, static_cast<int>(std::lround(static_cast<double>(out.cell_width) *
                                                           cell.image.height / cell.image.width)));
  return out;
}

void draw_cell(Image& sheet, const SheetCell& cell, int x, int y, const SheetLayout& layout,
               const Fonts& fonts) {
  const Rect rect{static_cast<double>(x), static_cast<double>(y),
                  static_cast<double>(layout.cell_width),
                  static_cast<double>(layout.picture_height + layout.caption_height)};
  fill_shadow(sheet, {rect.x, rect.y + 1, rect.width, rect.height}, 3, layout.gap * 0.4,
              {32, 38, 48, 0.30});
  fill_round_rect(sheet, rect, 3, card);
  if (cell.image.width > 0 && cell.image.height > 0) {
    const int height =
        std::clamp(static_cast<int>(std::lround(static_cast<double>(layout.cell_width) *
                                                cell.image.height / cell.image.width)),
                   1, layout.picture_height);
    paste(sheet, resampled(cell.image, layout.cell_width, height), x,
          y + (layout.picture_height - height) / 2);
  }
  const double inset = layout.text * 0.7;
  fonts.draw(sheet, x + inset, y + layout.picture_height + layout.text * 1.35,
             fonts.fitted(cell.caption, Face::sans, layout.text, layout.cell_width - 2 * inset),
             Face::sans, layout.text, dark);
}

}  // namespace

Image contact_sheet(const std::vector<SheetCell>& cells, int columns, int cell_width,
                    const std::string& title) {
  const auto fonts = Fonts::load(font_folders());
  if (!fonts) return {};
  const SheetLayout layout = lay_out(cells, columns, cell_width, !title.empty());
  Image out = make_image(layout.width(), layout.height(), paper);
  if (!title.empty())
    fonts->draw(out, layout.gap, layout.gap + layout.title,
                fonts->fitted(title, Face::bold, layout.title, layout.width() - 2 * layout.gap),
                Face::bold, layout.title, dark);
  for (int i = 0; i < static_cast<int>(cells.size()); ++i) {
    const int x = layout.gap + (i % layout.columns) * (layout.cell_width + layout.gap);
    const int y =
        layout.head + layout.gap +
        (i / layout.columns) * (layout.picture_height + layout.caption_height + layout.gap);
    draw_cell(out, cells[static_cast<std::size_t>(i)], x, y, layout, *fonts);
  }
  return out;
}

}  // namespace aircut::render
