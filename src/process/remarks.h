// Private: what is said once of a tool, however many of its stretches say it.
#pragma once

#include <string>
#include <vector>

#include "base/base.h"

namespace aircut::process {

struct Remark {
  std::string kind, text;
  std::size_t tool = 0;
  SourceSpan span;  ///< of the first
  Severity severity = Severity::warning;
  std::size_t count = 0;
};

class Remarks {
 public:
  void say(const char* kind, std::size_t tool, const SourceSpan& span, const std::string& text,
           Severity severity = Severity::warning) {
    for (Remark& said : list_)
      if (said.tool == tool && said.kind == kind && said.text == text) {
        ++said.count;
        return;
      }
    list_.push_back({kind, text, tool, span, severity, 1});
  }
  const std::vector<Remark>& list() const { return list_; }

 private:
  std::vector<Remark> list_;
};

}  // namespace aircut::process
