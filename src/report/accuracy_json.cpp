#include "report/accuracy_json.h"

#include "report/accuracy_along.h"
#include "report/json_items.h"

namespace aircut::report {
namespace {

using namespace accuracy;

Json vector_item(const Vec3& v, double unit = 1) {
  return Json::array({v[0] * unit, v[1] * unit, v[2] * unit});
}

std::string policy_name(SignPolicy policy) {
  switch (policy) {
    case SignPolicy::check:
      return "check";
    case SignPolicy::as_given:
      return "as_given";
    case SignPolicy::row_flip:
      return "row_flip";
    case SignPolicy::column_flip:
      return "column_flip";
    case SignPolicy::abs_diagonal:
      break;
  }
  return "abs_diagonal";
}

Json settings_item(const Setup& setup) {
  Json out;
  out["sign_policy"] = policy_name(setup.settings.repair.policy);
  out["symmetrize"] = setup.settings.repair.symmetrize;
  out["psd_project"] = setup.settings.repair.psd_project;
  out["coupled"] = setup.settings.coupled;
  out["second_order"] = setup.settings.second_order;
  out["speed_diameter"] = setup.settings.mean_diameter ? "mean" : "outer";
  out["epsilon"] = setup.scatter.bands.epsilon;
  out["nu"] = setup.scatter.bands.nu;
  out["mode"] = setup.scatter.exact ? "exact" : "linear";
  out["independent_bodies"] = setup.scatter.independent_bodies;
  if (setup.scatter.draws) {
    out["draws"] = setup.scatter.draws->count;
    out["seed"] = setup.scatter.draws->seed;
  }
  return out;
}

Json field_item(const Setup& setup, const Field& field) {
  Json out;
  out["kind"] = field.opposed ? "opposed" : "non-opposed";
  out["case"] = name_of(field.which);
  out["N_um"] = field.N * 1e3;
  out["D_um"] = field.D * 1e3;
  out["low_um"] = field.low * 1e3;
  out["high_um"] = field.high * 1e3;
  out["field_um"] = field.width() * 1e3;
  out["mode"] = setup.scatter.independent_bodies ? "independent bodies"
                : setup.scatter.exact            ? "exact"
                                                 : "linear";
  if (const auto& s = field.sample)
    out["drawn"] = {{"mean_um", s->mean * 1e3},   {"sigma_um", s->sigma * 1e3},
                    {"low_um", s->low * 1e3},     {"high_um", s->high * 1e3},
                    {"q_low_um", s->q_low * 1e3}, {"q_high_um", s->q_high * 1e3}};
  return out;
}

Json contact_item(const Setup& setup, const SegmentResult& segment, const ContactResult& c) {
  const ContactEntry& entry = setup.contacts[c.contact];
  Json out;
  out["contact"] = utf8(entry.name);
  out["line"] = entry.place.line;
  out["tool"] = setup.tools[entry.tool].id;
  out["spindle"] = setup.works[entry.work].spindle;
  out["t_mm"] = c.t;
  out["S_mm_rev"] = entry.S;
  out["V_m_min"] = entry.V;
  out["D_mm"] = entry.diameter;
  out["area_mm2"] = entry.S * c.t;
  out["F_cut_N"] = c.P_cut;
  out["power_kW"] = c.power;
  out["torque_Nm"] = c.torque * 1e-3;
  out["F_N"] = vector_item(c.load.force);
  out["M_Nm"] = vector_item(c.load.moment, 1e-3);
  out["A_mm"] = vector_item(entry.contact.point);
  out["w_um"] = vector_item(c.moved.displacement, 1e3);
  out["rot_urad"] = vector_item(c.moved.rotation, 1e6);
  if (c.delta) out["delta_um"] = *c.delta * 1e3;
  if (setup.settings.coupled) out["copied_form"] = c.copy_ratio;
  Json split = Json::array();
  for (const ErrorShare& share : c.shares)
    split.push_back({{"body", utf8(setup.bodies[share.body].name)},
                     {"source", utf8(setup.contacts[segment.contacts[share.source].contact].name)},
                     {"delta_um", share.delta * 1e3}});
  out["split"] = std::move(split);
  if (c.field) out["scatter"] = field_item(setup, *c.field);
  out["source"] = utf8(entry.source);
  return out;
}

Json influence_item(const Influence& influence) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < influence.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      Json row = Json::array();
      for (std::size_t l = 0; l < influence.size(); ++l)
        for (int j = 0; j < 3; ++j) row.push_back(influence.E(k, l)(i, j) * 1e3);
      rows.push_back(std::move(row));
    }
  return rows;
}

Json dimension_item(const Setup& setup, const Dimension& asked, const DimensionResult& d) {
  Json out;
  out["name"] = utf8(asked.name);
  out["kind"] = name_of(asked.kind);
  out["nominal_mm"] = asked.nominal;
  if (!d.unchecked.empty()) {
    out["unchecked"] = d.unchecked;
    return out;
  }
  out["error_min_um"] = d.least * 1e3;
  out["error_max_um"] = d.most * 1e3;
  out["error_mean_um"] = d.mean * 1e3;
  out["scatter"] = field_item(setup, d.field);
  if (d.it_grade) out["it_grade"] = *d.it_grade;
  if (d.capability) {
    out["tolerance_um"] = Json::array({asked.tolerance->low * 1e3, asked.tolerance->high * 1e3});
    out["compensate"] = asked.compensate;
    out["C_p"] = d.capability->cp;
    out["fits"] = d.capability->fits;
  }
  return out;
}

Json diagnostic_item(const Diagnostic& d) {
  Json out;
  out["severity"] = std::string(to_string(d.severity));
  out["kind"] = d.kind;
  out["message"] = utf8(d.message);
  if (d.span) {
    out["line"] = d.span.line;
    out["column"] = d.span.column();
  }
  return out;
}

Json worst_item(const process::Worst& worst, double unit = 1) {
  return {{"value", worst.value * unit}, {"line", worst.span.line}, {"t_s", worst.t}};
}

Json tool_item(const Setup& setup, const process::ToolSummary& tool) {
  Json out;
  out["tool"] = setup.tools[tool.tool].id;
  out["stretches"] = tool.stretches;
  out["time_s"] = tool.time;
  out["removed_mm3"] = tool.volume;
  out["F_cut_N"] = worst_item(tool.force);
  out["power_kW"] = worst_item(tool.power);
  out["torque_Nm"] = worst_item(tool.torque, 1e-3);
  out["chip_mm"] = worst_item(tool.chip);
  out["displacement_um"] = worst_item(tool.deflection, 1e3);
  out["delta_min_um"] = worst_item(tool.least, 1e3);
  out["delta_max_um"] = worst_item(tool.most, 1e3);
  out["delta_mean_um"] = tool.mean * 1e3;
  Json shares = Json::array();
  for (std::size_t b = 0; b < tool.shares.size(); ++b)
    if (tool.shares[b] != 0)
      shares.push_back(
          {{"body", utf8(setup.bodies[b].name)}, {"delta_mean_um", tool.shares[b] * 1e3}});
  out["split"] = std::move(shares);
  return out;
}

}  // namespace

Json along_item(const AccuracyAlong& along) {
  Json out;
  out["verdict"] = along.verdict;
  out["file"] = utf8(along.file);
  out["stretches"] = along.summary.stretches;
  out["time_s"] = along.summary.time;
  Json tools = Json::array();
  for (const process::ToolSummary& tool : along.summary.tools)
    tools.push_back(tool_item(along.setup, tool));
  out["tools"] = std::move(tools);
  Json dimensions = Json::array();
  for (std::size_t i = 0; i < along.summary.dimensions.size(); ++i)
    dimensions.push_back(
        dimension_item(along.setup, along.setup.dimensions[i], along.summary.dimensions[i]));
  out["dimensions"] = std::move(dimensions);
  Json unchecked = Json::array();
  for (const std::string& what : along.summary.unchecked) unchecked.push_back(utf8(what));
  out["unchecked"] = std::move(unchecked);
  Json sources = Json::array();
  for (const std::string& source : along.summary.sources) sources.push_back(utf8(source));
  out["sources"] = std::move(sources);
  return out;
}

std::string along_json(const AccuracyAlong& along, const std::string& version,
                       const std::string& sha256, const std::vector<Diagnostic>& diagnostics) {
  Json out;
  out["schema"] = 1;
  out["aircut"] = version;
  out["input"] = {{"path", utf8(along.file)}, {"sha256", sha256}};
  out["settings"] = settings_item(along.setup);
  out["repairs"] = along.setup.changes;
  out.update(along_item(along));
  out["segments"] = "accuracy.csv";
  Json list = Json::array();
  for (const Diagnostic& d : diagnostics) list.push_back(diagnostic_item(d));
  out["diagnostics"] = std::move(list);
  return json_text(out, 2);
}

std::string along_text(const AccuracyAlong& along) {
  const auto um = [](double mm) { return fixed(mm * 1e3, 1); };
  std::string out = "  accuracy " + along.verdict + ": " + std::to_string(along.summary.stretches) +
                    " stretches, " + fixed(along.summary.time, 1) + " s in the material\n";
  for (const process::ToolSummary& tool : along.summary.tools) {
    out += "             T" + std::to_string(along.setup.tools[tool.tool].id) + "  up to " +
           fixed(tool.force.value, 0) + " N, " + fixed(tool.power.value, 2) +
           " kW; surface off by " + um(tool.least.value) + " … " + um(tool.most.value) +
           " µm, mean " + um(tool.mean);
    for (std::size_t b = 0; b < tool.shares.size(); ++b)
      if (tool.shares[b] != 0)
        out += ", " + printable(along.setup.bodies[b].name) + " " + um(tool.shares[b]);
    out += "\n";
  }
  for (std::size_t i = 0; i < along.summary.dimensions.size(); ++i) {
    const Dimension& asked = along.setup.dimensions[i];
    const DimensionResult& d = along.summary.dimensions[i];
    out += "             size " + printable(asked.name) + ": ";
    if (!d.unchecked.empty()) {
      out += "not known, " + d.unchecked + "\n";
      continue;
    }
    out += "off by " + um(d.least) + " … " + um(d.most) + " µm, batch " + um(d.field.low) + " … " +
           um(d.field.high) + " µm";
    if (d.capability)
      out += ", tolerance " + um(asked.tolerance->low) + " … " + um(asked.tolerance->high) +
             (d.capability->fits ? ": fits" : ": does not fit");
    out += "\n";
  }
  return out;
}

std::string accuracy_json(const AccuracyReport& report, const Setup& setup, const Result& result) {
  Json out;
  out["schema"] = 1;
  out["aircut"] = report.version;
  out["verdict"] = report.verdict;
  out["input"] = {{"path", utf8(report.file)}, {"sha256", report.sha256}};
  out["settings"] = settings_item(setup);
  out["repairs"] = setup.changes;
  Json segments = Json::array();
  for (const SegmentResult& segment : result.segments) {
    Json one;
    if (segment.span) {
      one["t0_s"] = segment.span->from;
      one["t1_s"] = segment.span->to;
    }
    Json active = Json::array();
    for (const ContactResult& c : segment.contacts)
      active.push_back(contact_item(setup, segment, c));
    one["active"] = std::move(active);
    if (report.with_influence) one["E_um_per_N"] = influence_item(segment.influence);
    segments.push_back(std::move(one));
  }
  out["segments"] = std::move(segments);
  Json dimensions = Json::array();
  for (std::size_t i = 0; i < setup.dimensions.size(); ++i)
    dimensions.push_back(dimension_item(setup, setup.dimensions[i], result.dimensions[i]));
  out["dimensions"] = std::move(dimensions);
  Json diagnostics = Json::array();
  for (const Diagnostic& d : report.diagnostics.list()) diagnostics.push_back(diagnostic_item(d));
  out["diagnostics"] = std::move(diagnostics);
  return json_text(out, 2);
}

}  // namespace aircut::report
