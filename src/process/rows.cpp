#include "process/rows.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace aircut::process {

namespace {

void append(std::string& out, double value) {
  if (std::abs(value) < 1e-9) value = 0;  // rounding of what is zero
  std::array<char, 40> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6);
  out += ',';
  out.append(buffer.data(), end.ptr);
}

}  // namespace

Expected<void> Rows::write_to(const std::string& path) {
  auto file = OutputFile::create(path);
  if (!file) return unexpected(file.error());
  file_ = std::move(*file);
  file_->write(
      "segment,t0_s,t1_s,channel,line,block,tool,spindle,t_mm,width_mm,S_mm_rev,V_m_min,D_mm,Q_mm3_"
      "s,"
      "area_mm2,chip_mm,F_cut_N,power_kW,torque_Nm,F_x_N,F_y_N,F_z_N,M_x_Nm,M_y_Nm,M_z_Nm,A_x_mm,"
      "A_y_mm,A_z_mm,w_x_um,w_y_um,w_z_um,rot_x_urad,rot_y_urad,rot_z_urad,delta_um,floor_um,"
      "scatter_low_um,scatter_high_um\n");
  return {};
}

void Rows::add(std::size_t segment, const Setup& setup, const Engaged& engaged,
               const Answer& found) {
  if (!file_) return;
  const sim::Cut& cut = *engaged.cut;
  const CutContact& contact = engaged.contact;
  line_ = std::to_string(segment);
  append(line_, cut.t0);
  append(line_, cut.t1);
  line_ += ',' + std::to_string(cut.channel + 1) + ',' + std::to_string(cut.span.line) + ',' +
           std::to_string(cut.block) + ',' + std::to_string(setup.tools[engaged.tool].id) + ',' +
           std::to_string(setup.works[0].spindle);
  const double turns = std::abs(cut.rpm) / 60 * (cut.t1 - cut.t0);
  const double circle = cut.turned ? std::numbers::pi * cut.mean * turns : 0;
  for (const double value : {found.t, contact.width, contact.S, contact.V, contact.diameter,
                             cut.volume / (cut.t1 - cut.t0), circle > 0 ? cut.volume / circle : 0.0,
                             contact.chip, found.P_cut, found.power, found.torque * 1e-3})
    append(line_, value);
  const auto add3 = [&](const Vec3& v, double unit) {
    for (int i = 0; i < 3; ++i) append(line_, v[i] * unit);
  };
  add3(found.load.force, 1);
  add3(found.load.moment, 1e-3);
  add3(cut.point, 1);
  add3(found.moved.displacement, 1e3);
  add3(found.moved.rotation, 1e6);
  append(line_, found.delta * 1e3);
  if (contact.floor.isZero())
    line_ += ',';
  else
    append(line_, found.floor * 1e3);
  if (found.field) {
    append(line_, found.field->low * 1e3);
    append(line_, found.field->high * 1e3);
  } else {
    line_ += ",,";
  }
  line_ += '\n';
  file_->write(line_);
}

Expected<void> Rows::result() {
  if (!file_) return {};
  return file_->commit();
}

}  // namespace aircut::process
