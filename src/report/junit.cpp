// JUnit XML, for build servers: one suite per program, one case per kind of message, and the case
// `checked`, which asks whether everything was checked. Build servers know two ways of not passing:
//
//   <failure>  a message of this kind is at or above the fail level
//   <error>    something of this kind, or of the program, could not be verified
//
// A kind with neither (a warning below the fail level) passes and keeps its text as output. There
// are no times and no host name: the same run gives the same bytes.

#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "report/messages.h"

namespace aircut::report {

namespace {

struct Case {
  std::vector<const Message*> failing, open, rest;
};

struct Suite {
  std::string name;
  std::map<std::string, Case> cases;   ///< by kind
  std::vector<std::string> unchecked;  ///< of the program
  bool unknown = false;
};

// The messages as people read them. Their control characters are shown already; what is left are
// line ends.
std::string text_of(const std::vector<const Message*>& messages) {
  std::string out;
  for (const Message* message : messages) out += format_human(message->text, {});
  return harmless(out);
}

void put_text(pugi::xml_node parent, const char* name, const std::string& type,
              const std::vector<const Message*>& list) {
  pugi::xml_node node = parent.append_child(name);
  std::string first = printable(list.front()->text.message);
  if (list.size() > 1) first += " (and " + std::to_string(list.size() - 1) + " more)";
  node.append_attribute("message") = first.c_str();
  node.append_attribute("type") = type.c_str();
  node.text().set(text_of(list).c_str());
}

struct Counts {
  unsigned tests = 0, failures = 0, errors = 0;
  void put(pugi::xml_node node) const {
    node.append_attribute("tests") = tests;
    node.append_attribute("failures") = failures;
    node.append_attribute("errors") = errors;
  }
};

pugi::xml_node add_case(pugi::xml_node parent, const std::string& suite, const std::string& name) {
  pugi::xml_node node = parent.append_child("testcase");
  node.append_attribute("classname") = suite.c_str();
  node.append_attribute("name") = name.c_str();
  return node;
}

void put_checked(pugi::xml_node parent, const Suite& suite, const std::string& name,
                 Counts& counts) {
  pugi::xml_node node = add_case(parent, name, "checked");
  ++counts.tests;
  if (suite.unchecked.empty() && !suite.unknown) return;
  ++counts.errors;
  std::string text;
  for (const std::string& what : suite.unchecked) text += printable(what) + "\n";
  pugi::xml_node error = node.append_child("error");
  error.append_attribute("message") = suite.unchecked.empty()
                                          ? "the verdict is unknown"
                                          : printable(suite.unchecked.front()).c_str();
  error.append_attribute("type") = "not_checked";
  error.text().set(text.c_str());
}

Counts put_suite(pugi::xml_node parent, const Suite& suite) {
  Counts counts;
  pugi::xml_node node = parent.append_child("testsuite");
  const std::string name = printable(suite.name);
  node.append_attribute("name") = name.c_str();
  put_checked(node, suite, name, counts);
  for (const auto& [kind, row] : suite.cases) {
    pugi::xml_node test = add_case(node, name, kind);
    ++counts.tests;
    if (!row.failing.empty()) {
      ++counts.failures;
      put_text(test, "failure", kind, row.failing);
    } else if (!row.open.empty()) {
      ++counts.errors;
      put_text(test, "error", kind, row.open);
    }
    if (!row.rest.empty()) test.append_child("system-out").text().set(text_of(row.rest).c_str());
  }
  counts.put(node);
  return counts;
}

// A suite per program, and one for messages about inputs that all programs share.
std::vector<Suite> suites_of(const RunReport& report, const std::vector<Message>& all) {
  std::vector<Suite> suites;
  for (const Unit& unit : units_of(report))
    suites.push_back({unit.program, {}, unit.unchecked, unit.verdict == sim::Verdict::unknown});
  const auto put = [&](Suite& suite, const Message& message) {
    Case& row = suite.cases[message.text.kind];
    (fails(message, report)  ? row.failing
     : message.makes_unknown ? row.open
                             : row.rest)
        .push_back(&message);
  };
  if (report.units.empty()) {
    for (const Message& message : all) put(suites.front(), message);
    return suites;
  }
  // Diagnostics stand first, in the order of the report; each unit has a range of them.
  std::vector<std::size_t> home(all.size(), suites.size());
  for (std::size_t u = 0; u < report.units.size(); ++u)
    for (std::size_t i = 0; i < report.units[u].count; ++i) home.at(report.units[u].first + i) = u;
  Suite inputs{"inputs", {}, {}, false};
  for (std::size_t i = 0; i < all.size(); ++i)
    put(home[i] < suites.size() ? suites[home[i]] : inputs, all[i]);
  if (!inputs.cases.empty()) suites.insert(suites.begin(), std::move(inputs));
  return suites;
}

}  // namespace

std::string to_junit(const RunReport& report) {
  const std::vector<Message> all = messages(report, Take::episodes);
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = document.append_child("testsuites");
  root.append_attribute("name") = "aircut";
  Counts counts;
  for (const Suite& suite : suites_of(report, all)) {
    const Counts more = put_suite(root, suite);
    counts.tests += more.tests;
    counts.failures += more.failures;
    counts.errors += more.errors;
  }
  counts.put(root);
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return out.str();
}

}  // namespace aircut::report
