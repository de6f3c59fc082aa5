// Cuts come in the order of time. Those that are under way at the same time are put together
// (together.h), become contacts (contact.h), and load the elastic machine as one (elastic.h). What
// comes of it goes to a table (rows.h), to the summaries (tally.h) and onto the part (part_map.h).
#include <algorithm>

#include "process/chatter.h"
#include "process/part_map.h"
#include "process/rows.h"
#include "process/tally.h"
#include "process/together.h"

namespace aircut::process {

class Along::Impl {
 public:
  Impl(const Setup& setup, std::shared_ptr<const machine::Machine> machine, Diagnostics& out)
      : setup_(setup),
        machine_(std::move(machine)),
        errors_before_(out.errors()),
        elastic_(setup, *machine_, remarks_, out),
        tally_(setup, remarks_),
        chatter_(setup),
        together_([this](std::vector<sim::Cut>& cuts) { take(cuts); }) {
    usable_ = out.errors() == errors_before_;
  }
  void on_cut(const sim::Cut& cut);
  Summary finish(Diagnostics& out);
  Rows& rows() { return rows_; }
  PartMap& map() { return map_; }

 private:
  void take(std::vector<sim::Cut>& cuts);
  bool engage(const sim::Cut& cut);

  const Setup& setup_;
  std::shared_ptr<const machine::Machine> machine_;
  std::size_t errors_before_ = 0;
  Remarks remarks_;
  Elastic elastic_;
  Tally tally_;
  Rows rows_;
  PartMap map_;
  Chatter chatter_;
  Together together_;
  bool usable_ = false, out_of_order_ = false;
  std::vector<Engaged> engaged_;
  std::size_t segments_ = 0;
  double time_ = 0;
};

void Along::Impl::on_cut(const sim::Cut& cut) {
  if (usable_ && !together_.add(cut)) out_of_order_ = true;
}

bool Along::Impl::engage(const sim::Cut& cut) {
  const auto found = std::find_if(setup_.tools.begin(), setup_.tools.end(),
                                  [&](const auto& tool) { return tool.id == cut.tool; });
  const auto tool = static_cast<std::size_t>(found - setup_.tools.begin());
  const std::string name = "T" + std::to_string(cut.tool);
  if (found == setup_.tools.end()) {
    remarks_.say("force_unknown", tool, cut.span,
                 name + " is not under [[tools]] of the accuracy file");
    return false;
  }
  std::string why;
  auto contact = contact_of(setup_, tool, 0, cut, why);
  if (!contact) {
    remarks_.say("force_unknown", tool, cut.span, "the force of " + name + " is not known: " + why);
    return false;
  }
  engaged_.push_back({&cut, tool, std::move(*contact), found->cutter ? &*found->cutter : nullptr});
  return true;
}

void Along::Impl::take(std::vector<sim::Cut>& cuts) {
  engaged_.clear();
  bool all = true;
  for (const sim::Cut& cut : cuts) all = engage(cut) && all;
  if (engaged_.empty()) return;
  if (!all)
    for (const Engaged& one : engaged_)
      remarks_.say("force_unknown", one.tool, one.cut->span,
                   "what cuts together with T" + std::to_string(one.cut->tool) +
                       " loads the machine too, with a force that is not known");
  const sim::Cut& latest = *engaged_.back().cut;
  if (latest.joints.size() > 0) elastic_.place(latest.joints);
  const auto found = elastic_.answer(engaged_);
  for (std::size_t k = 0; k < found.size(); ++k)
    if (!found[k].moved.displacement.allFinite() || !found[k].load.force.allFinite()) {
      remarks_.say(
          "force_unknown", engaged_[k].tool, engaged_[k].cut->span,
          "the displacement of T" + std::to_string(engaged_[k].cut->tool) + " is no finite number");
      return;
    }
  ++segments_;
  time_ += latest.t1 - latest.t0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    tally_.add(engaged_[k], found[k], elastic_.sides(engaged_[k].tool));
    rows_.add(segments_, setup_, engaged_[k], found[k]);
    chatter_.look(engaged_[k]);
    map_.add(*machine_, engaged_[k], found[k]);
  }
}

Summary Along::Impl::finish(Diagnostics& out) {
  Summary sum;
  if (!usable_) {
    sum.unchecked.push_back("the accuracy: its file does not fit the machine");
    return sum;
  }
  together_.finish();
  sum = tally_.finish(out);
  chatter_.finish(out);
  sum.time = time_;
  if (out_of_order_)
    sum.unchecked.push_back(
        "the accuracy: cuts of several channels came in another order than that of time");
  return sum;
}

Along::Along(const Setup& setup, std::shared_ptr<const machine::Machine> machine, Diagnostics& out)
    : impl_(std::make_unique<Impl>(setup, std::move(machine), out)) {}
Along::~Along() = default;
Expected<void> Along::write_to(const std::string& path) { return impl_->rows().write_to(path); }
void Along::keep_places() { impl_->map().keep(); }
std::vector<std::optional<double>> Along::on_part(const TriangleMesh& mesh) const {
  return impl_->map().on(mesh);
}
void Along::on_cut(const sim::Cut& cut) { impl_->on_cut(cut); }
Summary Along::finish(Diagnostics& out) { return impl_->finish(out); }
Expected<void> Along::result() { return impl_->rows().result(); }

}  // namespace aircut::process
