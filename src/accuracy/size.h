// From displacements to the errors of named sizes, and the segments of time in which the same tools
// cut together.
#pragma once

#include <span>
#include <vector>

#include "accuracy/structure.h"

namespace aircut::accuracy {

enum class SizeKind {
  outside_diameter,
  bore_diameter,
  length,   ///< a face's position, a depth, a length: along the face's normal
  width,    ///< between the surfaces of two tools
  profile,  ///< any surface point: material left is positive
};

/// The error of a size for a normal error δ (material left is positive); of a width δ is the sum
/// over both tools.
double size_error(SizeKind kind, double delta);

/// δ = n·w.
double normal_error(const Vec3& normal, const Vec3& w);
/// With the circle of a turned surface: a tangential displacement w_t moves a point at the radius R
/// to √((R + w_r)² + w_t²). `axis`: unit vector of the spindle, `arm`: from a point of it to the
/// tool.
double normal_error_exact(const Vec3& normal, const Vec3& axis, const Vec3& arm, const Vec3& w);

/// When a contact cuts, s.
struct Span {
  double from = 0, to = 0;
};
struct ActiveSegment {
  double from = 0, to = 0;
  std::vector<std::size_t> active;  ///< contacts, rising
};
/// Cuts the time at every entry and exit; pieces in which nothing cuts are left out.
std::vector<ActiveSegment> active_segments(std::span<const Span> contacts);

/// One body's part in the normal error of contact k, caused by the load of contact l.
struct ErrorShare {
  std::size_t body = 0, source = 0;
  double delta = 0;
};
/// All parts that are not zero; they sum to normal · w_k.
std::vector<ErrorShare> error_shares(const Structure& structure, std::span<const Contact> contacts,
                                     std::span<const Load> loads, std::size_t k,
                                     const Vec3& normal);

}  // namespace aircut::accuracy
