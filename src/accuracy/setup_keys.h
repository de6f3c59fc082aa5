// Private: what the readers of the set-up's tables share.
#pragma once

#include "accuracy/setup.h"
#include "config/config.h"

namespace aircut::accuracy {

using config::Table;

constexpr double degree = 0.017453292519943295;  // rad
constexpr double per_micro = 1e-3;               // µm/N → mm/N, rad/(N·m) → rad/(N·mm)
constexpr double coupling_unit = 1e-6;           // µm/(N·m) → mm/(N·mm)

/// More than any machine has; keeps the time for a hostile file short.
constexpr std::size_t most_bodies = 128, most_contacts = 32;
constexpr long most_teeth = 200;
constexpr double most_depth = 20;  // of a milling cut, in diameters
constexpr long most_draws = 10'000'000;

/// Everything that is being read, and the names that were met.
struct SetupReading {
  Setup setup;
  std::map<std::string, int> body_index;
  std::map<long, std::size_t> tool_index, work_index;
  WhatIf what_if;  ///< what was used is taken out

  /// What the what-if says of a contact's key, if anything.
  std::optional<double> changed(const ContactEntry& contact, const std::string& key);

  std::optional<int> body(Table& table, const std::string& key);
  const Material* material(Table& table, const std::string& key, const std::string& name);
  std::optional<std::size_t> tool(Table& table, const std::string& key, long id);
};

void range_error(Table& table, const std::string& key, const std::string& message);
/// A number above 0 (`required`), or the range error.
double positive(Table& table, const std::string& key);
std::optional<double> positive_if(Table& table, const std::string& key);
std::optional<Vec3> vector3(Table& table, const std::string& key);
std::optional<Vec3> unit_vector(Table& table, const std::string& key);
std::optional<Mat3> matrix3(Table& table, const std::string& key);
std::string quoted(const std::string& name);

void read_bodies(Table& top, SetupReading& reading);
void read_materials(Table& top, SetupReading& reading);
void read_contacts(Table& top, SetupReading& reading);

}  // namespace aircut::accuracy
