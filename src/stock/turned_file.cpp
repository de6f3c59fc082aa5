// A turned stock as a file, for the next job on a lathe. After the first line
// `aircut turned stock 1` come the pitch, the radius and the length of the initial bar (doubles);
// then all rays along the radius, from z = 0 on, and all along Z, from the axis on: for each the
// number of its intervals (32 bits) and their ends (64 bits each, nanometres). The check sum closes
// it. What is read must lie within the bar, in order.
#include "stock/file_bytes.h"
#include "stock/stock.h"

namespace aircut::stock {

constexpr std::size_t digits = 64;  // of the check sum

Diagnostic file_error(const std::string& name, const std::string& why) {
  return make_error("stock_file", "'" + name + "' is no stock that can be used: " + why);
}

Expected<std::string_view> file_content(std::string_view bytes, std::string_view heading,
                                        const std::string& name) {
  const auto refuse = [&](const std::string& why) { return unexpected(file_error(name, why)); };
  if (!bytes.starts_with(heading)) {
    if (bytes.starts_with(turned_heading))
      return refuse(
          "it was saved on a machine whose spindle turns the work; only such a machine goes on "
          "with it");
    if (bytes.starts_with(milled_heading))
      return refuse(
          "it was saved on a machine whose spindle turns the tool; only such a machine goes on "
          "with it, a lathe needs a stock that was saved on a lathe");
    return refuse("it does not begin with '" + std::string(heading.substr(0, heading.size() - 1)) +
                  "'");
  }
  if (bytes.size() < heading.size() + digits) return refuse("it ends too early");
  const std::string_view content = bytes.substr(0, bytes.size() - digits);
  if (sha256(content) != bytes.substr(content.size()))
    return refuse("its check sum is wrong: it was changed, or not written to its end");
  return content.substr(heading.size());
}

std::string TurnedStock::save() const {
  FileWriter out(turned_heading);
  for (const double value : {pitch_, radius_, length_}) out.real(value);
  for (const auto* family : {&along_r_, &along_z_})
    for (const Ray& ray : *family) {
      out.number(static_cast<std::uint32_t>(ray.size()));
      for (const auto& [lo, hi] : ray) {
        out.number(lo);
        out.number(hi);
      }
    }
  return out.finish();
}

Expected<TurnedStock> TurnedStock::load(std::string_view bytes, const std::string& name,
                                        const StockOptions& options) {
  const auto content = file_content(bytes, turned_heading, name);
  if (!content) return unexpected(content.error());
  FileReader in(*content);
  const double pitch = in.real(), radius = in.real(), length = in.real();
  if (!in.good()) return unexpected(file_error(name, in.message()));
  auto bar = make(radius, 0, length, pitch, options);
  if (!bar) return unexpected(file_error(name, bar.error().message));
  for (auto* family : {&bar->along_r_, &bar->along_z_})
    for (Ray& ray : *family) {
      const Nanometres end = ray.empty() ? 0 : ray[0].second;
      ray.clear();
      Nanometres last = -1;
      for (auto n = in.number<std::uint32_t>(); n > 0 && in.good(); --n) {
        const auto lo = in.number<Nanometres>(), hi = in.number<Nanometres>();
        if (!in.good()) break;
        if (lo <= last || lo >= hi || hi > end) {
          in.wrong("the intervals of a ray are not in order, or outside of the bar");
          break;
        }
        last = hi;
        ray.emplace_back(lo, hi);
      }
    }
  if (in.good() && !in.at_end()) in.wrong("it goes on after its last ray");
  if (!in.good()) return unexpected(file_error(name, in.message()));
  return bar;
}

}  // namespace aircut::stock
