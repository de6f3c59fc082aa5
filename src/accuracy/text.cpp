#include "accuracy/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace aircut::accuracy {
namespace {

std::string um(double mm, int decimals = 3) { return fixed(mm * 1e3, decimals); }

std::string padded(const std::string& text, std::size_t width) {
  const std::size_t length = count_characters(text);
  return length >= width ? text + " " : text + std::string(width - length, ' ');
}

std::string right(const std::string& text, std::size_t width) {
  const std::size_t length = count_characters(text);
  return length >= width ? " " + text : std::string(width - length, ' ') + text;
}

std::string range(double low, double high) {
  return high > low ? um(low) + " … " + um(high) : um(low);
}

std::string contact_lines(const Setup& setup, const SegmentResult& segment) {
  std::string out = "  " + padded("contact", 12);
  for (const char* head :
       {"t mm", "F_cut N", "kW", "F_x N", "F_y N", "F_z N", "w_x µm", "w_y µm", "w_z µm", "δ µm"})
    out += right(head, 10);
  out += "\n";
  for (const ContactResult& c : segment.contacts) {
    out += "  " + padded(printable(setup.contacts[c.contact].name), 12) + right(fixed(c.t, 4), 10) +
           right(fixed(c.P_cut, 1), 10) + right(fixed(c.power, 3), 10);
    for (int i = 0; i < 3; ++i) out += right(fixed(c.load.force[i], 1), 10);
    for (int i = 0; i < 3; ++i) out += right(um(c.moved.displacement[i]), 10);
    out += right(c.delta ? um(*c.delta) : "-", 10) + "\n";
  }
  return out;
}

// Where δ comes from, largest first in the order of the bodies.
std::string share_lines(const Setup& setup, const SegmentResult& segment) {
  std::string out;
  for (const ContactResult& c : segment.contacts) {
    if (c.shares.empty()) continue;
    out += "\n  δ of " + printable(setup.contacts[c.contact].name) + " by body and force\n";
    for (const ErrorShare& share : c.shares) {
      const auto& source = setup.contacts[segment.contacts[share.source].contact].name;
      out += "    " + padded(printable(setup.bodies[share.body].name), 18) +
             padded("force of " + printable(source), 18) + right(um(share.delta), 10) + " µm\n";
    }
    if (!c.field) continue;
    out += "    scatter " + range(c.field->low, c.field->high) + " µm: " + um(c.field->width()) +
           " wide, tools " + (c.field->opposed ? "opposed" : "not opposed") + ", case " +
           name_of(c.field->which) + "\n";
    if (const auto& s = c.field->sample)
      out += "    drawn   " + range(s->q_low, s->q_high) + " µm hold 99.73 %, mean " + um(s->mean) +
             ", σ " + um(s->sigma) + "\n";
    if (setup.settings.coupled)
      out += "    of a form error of its blank " + fixed(100 * c.copy_ratio, 3) + " % is left\n";
  }
  return out;
}

std::string dimension_lines(const Setup& setup, const Result& result) {
  std::string out;
  for (std::size_t i = 0; i < setup.dimensions.size(); ++i) {
    const Dimension& asked = setup.dimensions[i];
    const DimensionResult& d = result.dimensions[i];
    out += "\n  size " + printable(asked.name) + ", " + name_of(asked.kind) + "\n";
    if (!d.unchecked.empty()) {
      out += "    not known: " + d.unchecked + "\n";
      continue;
    }
    out += "    error     " + range(d.least, d.most) + " µm\n";
    out += "    scatter   " + range(d.field.low, d.field.high) + " µm: " + um(d.field.width()) +
           " wide" + (d.it_grade ? ", as IT" + std::to_string(*d.it_grade) : "") + "\n";
    if (!d.capability) continue;
    out += "    tolerance " + range(asked.tolerance->low, asked.tolerance->high) +
           " µm: " + (d.capability->fits ? "fits" : "does not fit") +
           (asked.compensate ? " with the tool set to the middle" : "") +
           (d.capability->cp > 0 ? ", C_p " + fixed(d.capability->cp, 2) : "") + "\n";
  }
  return out;
}

}  // namespace

std::string csv_cell(const std::string& text) {
  const std::string valid = utf8(text);
  if (valid.find_first_of(",\"\r\n;") == valid.npos) return valid;
  std::string out = "\"";
  for (const char c : valid) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + "\"";
}

std::string significant(double value, int digits) {
  if (value == 0) return "0";  // no minus zero
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, digits);
  return std::string(buffer.data(), end.ptr);
}

std::string name_of(SizeKind kind) {
  switch (kind) {
    case SizeKind::outside_diameter:
      return "outside diameter";
    case SizeKind::bore_diameter:
      return "bore diameter";
    case SizeKind::length:
      return "length";
    case SizeKind::width:
      return "width";
    case SizeKind::profile:
      break;
  }
  return "profile";
}

std::string name_of(FieldCase which) {
  switch (which) {
    case FieldCase::all_positive:
      return "I";
    case FieldCase::all_negative:
      return "II";
    case FieldCase::zero_inside:
      break;
  }
  return "III";
}

std::string to_human(const Setup& setup, const Result& result) {
  std::string out;
  for (const std::string& change : setup.changes) out += "repaired  " + change + "\n";
  std::vector<std::string> sources;
  for (const ContactEntry& c : setup.contacts)
    if (!c.source.empty() && std::find(sources.begin(), sources.end(), c.source) == sources.end())
      sources.push_back(c.source);
  for (const std::string& source : sources) out += "forces    " + printable(source) + "\n";
  for (const SegmentResult& segment : result.segments) {
    out += (out.empty() ? "" : "\n");
    out += segment.span
               ? "t = " + fixed(segment.span->from, 3) + " … " + fixed(segment.span->to, 3) + " s\n"
               : std::string("all tools together\n");
    out += contact_lines(setup, segment) + share_lines(setup, segment);
  }
  return out + dimension_lines(setup, result);
}

std::string to_csv(const Setup& setup, const Result& result) {
  std::string out =
      "segment,t0_s,t1_s,contact,tool,spindle,t_mm,S_mm_rev,V_m_min,D_mm,F_cut_N,power_kW,torque_"
      "Nm,"
      "F_x_N,F_y_N,F_z_N,M_x_Nm,M_y_Nm,M_z_Nm,A_x_mm,A_y_mm,A_z_mm,w_x_um,w_y_um,w_z_um,"
      "rot_x_urad,rot_y_urad,rot_z_urad,delta_um,scatter_low_um,scatter_high_um\n";
  for (std::size_t s = 0; s < result.segments.size(); ++s)
    for (const ContactResult& c : result.segments[s].contacts) {
      const ContactEntry& entry = setup.contacts[c.contact];
      const auto& span = result.segments[s].span;
      const auto add = [&](double value) { out += "," + significant(value, 6); };
      const auto add3 = [&](const Vec3& v) {
        for (int i = 0; i < 3; ++i) add(v[i]);
      };
      out += std::to_string(s + 1) + ",";
      out += span ? significant(span->from, 6) + "," + significant(span->to, 6) : std::string(",");
      out += "," + csv_cell(entry.name) + "," + std::to_string(setup.tools[entry.tool].id) + "," +
             std::to_string(setup.works[entry.work].spindle);
      for (const double value :
           {c.t, entry.S, entry.V, entry.diameter, c.P_cut, c.power, c.torque * 1e-3})
        add(value);
      add3(c.load.force);
      add3(c.load.moment * 1e-3);
      add3(entry.contact.point);
      add3(c.moved.displacement * 1e3);
      add3(c.moved.rotation * 1e6);
      if (c.delta)
        add(*c.delta * 1e3);
      else
        out += ",";
      if (c.field) {
        add(c.field->low * 1e3);
        add(c.field->high * 1e3);
      } else {
        out += ",,";
      }
      out += "\n";
    }
  return out;
}

}  // namespace aircut::accuracy
