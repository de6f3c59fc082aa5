// All channels of a package at once.
//
// A package is read once for each channel, which gives its view: its axes driven, the others held.
// The views have the same links, couples and bodies; they differ in which couples are driven, in
// the kinematics, in the work and in the spindle. So the whole machine is the first view with every
// axis driven. A pose of it is any vector of joints: it needs no inverse, since each channel plans
// in its own view.
#include "machine/channels.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "machine/reading.h"

namespace aircut::machine {

namespace {

// The joints of all channels; the tip is that of the first one.
class AllChannels final : public Kinematics {
 public:
  AllChannels(std::shared_ptr<const Kinematics> first, std::vector<int> joints, int count)
      : first_(std::move(first)), joints_(std::move(joints)), count_(count) {}
  std::string_view type() const override { return "channels"; }
  AxisSet axes() const override { return first_->axes(); }
  int joint_count() const override { return count_; }
  tl::expected<JointVector, ReachError> inverse(const Target&, const JointVector&) const override {
    return unexpected(ReachError{"each channel has a tip of its own"});
  }
  tl::expected<AxisValues, ReachError> forward(const JointVector& joints,
                                               const AxisValues& tool_offset) const override {
    JointVector own(static_cast<Eigen::Index>(joints_.size()));
    for (std::size_t j = 0; j < joints_.size(); ++j)
      own[static_cast<Eigen::Index>(j)] = joints[joints_[j]];
    return first_->forward(own, tool_offset);
  }
  bool travel_bound(const TipInterval&, std::span<double>) const override { return false; }

 private:
  std::shared_ptr<const Kinematics> first_;
  std::vector<int> joints_;
  int count_;
};

Diagnostic wrong(const std::string& message) { return make_error("input", message); }

// The name of a channel that is given by name or by its number from 1.
Expected<std::string> name_of(const std::string& given, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), given) != names.end()) return given;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (given == std::to_string(i + 1)) return names[i];
  std::string known;
  for (std::size_t i = 0; i < names.size(); ++i)
    known += (i > 0 ? ", " : "") + names[i] + " (" + std::to_string(i + 1) + ")";
  return unexpected(wrong("there is no channel '" + printable(given) + "'." +
                          did_you_mean(given, names) + " There are " + known + "."));
}

std::shared_ptr<const Machine> whole_of(const std::vector<ChannelView>& channels,
                                        const std::vector<int>& driven) {
  auto whole = std::make_shared<Machine>(*channels.front().machine);
  whole->driven_ = driven;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    Joint& joint = whole->tree_[static_cast<std::size_t>(driven[i])];
    joint.driven = static_cast<int>(i);
    joint.held = false;
  }
  whole->models_.clear();
  whole->kinematics_ =
      std::make_shared<AllChannels>(channels.front().machine->kinematics_, channels.front().joints,
                                    static_cast<int>(driven.size()));
  return whole;
}

}  // namespace

std::optional<std::pair<int, int>> read_wait_codes(config::Table& top) {
  auto table = top.table("wait");
  if (!table) return std::nullopt;
  if (!table->has("codes")) table->error("codes", "'codes' is missing: codes = [first, last]");
  const auto codes = table->numbers("codes", 2);
  if (!codes) return std::nullopt;
  const auto whole = [](double code) { return code == std::floor(code) && code >= 0; };
  if (!whole((*codes)[0]) || !whole((*codes)[1]) || (*codes)[0] > (*codes)[1] ||
      (*codes)[1] > 99999) {
    table->error("codes",
                 "'codes' needs the first and the last number of the M-codes with which "
                 "channels wait, like [100, 199]");
    return std::nullopt;
  }
  return std::pair(static_cast<int>((*codes)[0]), static_cast<int>((*codes)[1]));
}

Expected<ChannelMachines> read_channel_machines(const std::string& path,
                                                const std::vector<std::string>& channels,
                                                SourceMap& sources, Diagnostics& out) {
  const auto fail = [&](Diagnostic problem) -> Expected<ChannelMachines> {
    if (out.errors() == 0) out.add(problem);
    return unexpected(std::move(problem));
  };
  const auto first = read_machine(path, sources, out);
  if (!first) return fail(first.error());
  const std::vector<std::string>& names = (*first)->channels();
  if (names.empty())
    return fail(wrong("the machine '" + (*first)->name() + "' has no channels ([[channel]])"));
  ChannelMachines all;
  std::set<std::string> seen;
  for (const std::string& given : channels) {
    const auto name = name_of(given, names);
    if (!name) return fail(name.error());
    if (!seen.insert(*name).second)
      return fail(wrong("the channel '" + *name + "' is there twice"));
    auto machine = read_machine(path, sources, out, *name);
    if (!machine) return fail(machine.error());
    if ((*machine)->kinematics().passive_count() > 0)
      return fail(wrong("the channel '" + *name + "' moves passive parts (" +
                        std::string((*machine)->kinematics().type()) +
                        "): such a channel runs alone only"));
    if ((*machine)->rapid() != RapidMode::coordinated)
      return fail(wrong("the rapids of the channel '" + *name +
                        "' are not coordinated: such a channel runs alone only"));
    all.channels.push_back({*name, std::move(*machine), {}});
  }
  std::vector<int> driven;
  for (std::size_t i = 0; i < all.channels.front().machine->tree().size(); ++i)
    driven.push_back(static_cast<int>(i));
  for (ChannelView& view : all.channels) view.joints = view.machine->driven_;
  if (driven.size() > static_cast<std::size_t>(max_joints))
    return fail(wrong("the machine has more than " + std::to_string(max_joints) + " axes"));
  all.whole = whole_of(all.channels, driven);
  const auto text =
      sources.open(std::filesystem::is_directory(path) ? path + "/machine.toml" : path);
  if (!text) return fail(text.error());
  config::Reader reader(**text, "machine_invalid");
  config::Table top = reader.top();
  all.wait = read_wait_codes(top);
  return all;
}

}  // namespace aircut::machine
