// Private: the elastic machine under the contacts that cut at the same time: what loads it, how far
// each tool moves against the work, the error of each surface and its scatter.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "accuracy/copying.h"
#include "process/contact.h"
#include "process/remarks.h"

namespace aircut::process {

/// One cut of a piece of time, as a contact.
struct Engaged {
  const sim::Cut* cut = nullptr;
  std::size_t tool = 0;  ///< place in Setup::tools
  CutContact contact;
  const accuracy::Cutter* cutter = nullptr;  ///< of the tool, if it mills
};

struct Answer {
  accuracy::Load load;
  accuracy::Response moved;
  double t = 0;  ///< that is really cut
  double delta = 0, floor = 0;
  double P_cut = 0, power = 0, torque = 0;
  std::optional<accuracy::Field> field;
  std::vector<double> shares;  ///< of each body in `delta`
};

class Elastic {
 public:
  /// All outlive it. Errors of the file against this machine go to `out`.
  Elastic(const Setup& setup, const machine::Machine& machine, Remarks& remarks, Diagnostics& out);

  /// The bodies go where the machine stands.
  void place(const machine::JointVector& joints);
  /// One answer for each contact, all loaded together; valid until the next call.
  std::span<const Answer> answer(std::span<const Engaged> engaged);
  /// Of a tool: +1 for the bodies on its side, −1 for those on the work's.
  const std::vector<int>& sides(std::size_t tool) const { return sides_[tool]; }

 private:
  void check_file(Diagnostics& out);
  void respond(std::span<const accuracy::Load> loads, accuracy::Structure::Scratch& scratch);
  const std::vector<double>& along_normals(std::size_t source, const accuracy::Load& load);
  void find_depths(std::span<const Engaged> engaged);
  void fields(std::span<const Engaged> engaged);
  void judge(const Engaged& engaged, Answer& out) const;
  void add_shares(const Engaged& engaged, Answer& out) const;

  const Setup& setup_;
  const machine::Machine& machine_;
  Remarks& remarks_;
  accuracy::Structure structure_;
  std::vector<std::optional<machine::LinkId>> links_;  // of bodies
  machine::LinkPoses poses_;
  machine::JointVector placed_;  // for which the bodies stand where they are
  bool moves_ = false, scatters_ = false;
  std::vector<std::vector<int>> sides_;  // of bodies, by tool
  // Of the contacts that are looked at.
  std::vector<accuracy::Contact> contacts_;
  std::vector<accuracy::Load> loads_;
  std::vector<accuracy::Response> moved_;
  std::vector<Answer> answers_;
  std::vector<Vec3> normals_;
  std::vector<double> row_;
  accuracy::Structure::Scratch scratch_;  // has the motions of the bodies for the shares
  accuracy::Structure::Scratch trial_;    // of other forces
};

}  // namespace aircut::process
