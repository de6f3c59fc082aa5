// The published test vectors of tests/data/accuracy, turned into the library's values. Files are in
// µm/N, rad/(N·m), N·m; the library in mm, N, rad, N·mm.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "accuracy/accuracy.h"

namespace aircut::accuracy::testing {

using nlohmann::json;

inline json vectors(const std::string& name) {
  std::ifstream in(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/accuracy/" + name + ".json");
  return json::parse(in);
}

struct Tolerance {
  double relative = 1e-9, absolute = 0;
  explicit Tolerance(const json& j)
      : relative(j.value("rel", 1e-9)), absolute(j.value("abs", 0.0)) {}
};

#define EXPECT_WITHIN(is, wanted, tolerance) \
  EXPECT_NEAR(is, wanted, (tolerance).absolute + (tolerance).relative * std::abs(double(wanted)))

inline Vec3 vec3(const json& j) {
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

inline Mat3 mat3(const json& j) {
  Mat3 out;
  for (int r = 0; r < 3; ++r) out.row(r) = vec3(j[static_cast<std::size_t>(r)]);
  return out;
}

/// Bodies and contacts of a case.
struct Case {
  std::vector<Body> bodies;
  std::vector<Contact> contacts;
  std::vector<Load> loads;
  std::map<std::string, int> index;
};

inline Case read_case(const json& input) {
  Case out;
  for (const json& j : input["bodies"]) {
    out.index[j["name"]] = static_cast<int>(out.bodies.size());
    Body body;
    body.name = j["name"];
    Compliance local;
    local.e = mat3(j["e"]) * 1e-3;
    if (j.contains("xi")) local.xi = mat3(j["xi"]) * 1e-3;
    if (j.contains("coupling")) local.c = mat3(j["coupling"]) * 1e-6;
    body.compliance = rotated(local, j.contains("R") ? mat3(j["R"]) : Mat3(Mat3::Identity()));
    if (j.contains("base_point")) body.base_point = vec3(j["base_point"]);
    out.bodies.push_back(body);
  }
  std::size_t i = 0;
  for (const json& j : input["bodies"]) {
    if (!j["parent"].is_null()) out.bodies[i].parent = out.index.at(j["parent"]);
    ++i;
  }
  for (const json& j : input["contacts"]) {
    out.contacts.push_back(
        {out.index.at(j["tool_body"]), out.index.at(j["work_body"]), vec3(j["point"])});
    Load load;
    load.force = vec3(j["force"]);
    if (j.contains("moment")) load.moment = vec3(j["moment"]) * 1e3;
    out.loads.push_back(load);
  }
  return out;
}

inline PowerTerm power_term(const json& j) {
  return {.C = j["C"], .x = j["x"], .y = j["y"], .z = j["z"], .K = j["K"]};
}

inline TurningLaw turning_law(const json& j) {
  TurningLaw law;
  law.cut = power_term(j["c"]);
  law.thrust = power_term(j["p"]);
  law.feed = power_term(j["f"]);
  return law;
}

inline MillingCoefficients coefficients(const json& j) {
  return {j["Ktc"], j["Krc"], j["Kac"], j["Kte"], j["Kre"], j["Kae"]};
}

inline MillingMode milling_mode(const std::string& word) {
  return word == "up" ? MillingMode::up : word == "down" ? MillingMode::down : MillingMode::slot;
}

/// The force of a turning contact by its depth.
inline DepthForce depth_force(const TurningLaw& law, const Triad& triad, double S, double V) {
  DepthForce out;
  const PowerTerm* laws[] = {&law.cut, &law.thrust, &law.feed};
  const Vec3* directions[] = {&triad.cut, &triad.thrust, &triad.feed};
  for (std::size_t i = 0; i < 3; ++i)
    out.terms[i] = {*directions[i], laws[i]->at(1, S, V), laws[i]->x};
  return out;
}

}  // namespace aircut::accuracy::testing
