// The layout of a new package, with every joint at zero (mm, bed axes):
//
//   Z is the axis of the main spindle and leads out of its chuck, X is radial. The chuck's face is
//   at z = 0, the gauge point of the first tool on the spindle's axis at z = 620. Behind (at +Y)
//   stands the bed; slides lie in layers from the bed towards the spindle, 10 mm apart:
//
//      bed │ slide 1 │ slide 2 │ turret          the second tool branch is the mirror image of the
//   +Y  ←──┴─────────┴─────────┴── y = 0         first one in X; the workpiece's slides lie behind
//                                                its chuck
//
//   A further chain with tools of its own stands beside the first one, at −Y; one without tools (a
//   counter spindle) faces the first one from z = 1500, and its Z is reversed.
//
// NC axes get program words: their own letter when it is free, else U V W or A B C. With X, Y, Z
// and rotary axes on one way from work to tool the kinematics is `chain`, else `identity`.
#include "machine/formula/new_package.h"

#include <algorithm>
#include <array>
#include <map>

#include "geometry/geometry.h"

namespace aircut::machine {

namespace {

constexpr double gauge_z = 620, counter_z = 1500, beside = 1200;

/// Travel and speed of an axis by its letter in the formula.
struct Range {
  double min, max, home, vmax, amax;
};
Range range_of(char letter) {
  switch (letter) {
    case 'X':
    case 'U':
      return {-20, 200, 200, 400, 4000};
    case 'Y':
    case 'V':
      return {-100, 100, 0, 300, 3000};
    case 'Z':
    case 'W':
      return {-600, 0, 0, 400, 4000};
    default:
      return {-95, 95, 0, 180, 900};  // A, B; a C turns without end
  }
}

Vec3 direction_of(char letter) {
  if (letter >= 'A' && letter <= 'C') return Vec3::Unit(letter - 'A');
  return Vec3::Unit(letter >= 'X' ? letter - 'X' : letter - 'U');
}

std::string list_of(const Vec3& v) {
  return "[" + shortest(v.x()) + ", " + shortest(v.y()) + ", " + shortest(v.z()) + "]";
}

/// A chain of the formula and where it stands.
struct Place {
  double y = 0;
  bool counter = false;  ///< faces the first chain
};

class Package {
 public:
  Package(const Formula& formula, const std::string& name) : formula_(formula), name_(name) {}

  tl::expected<std::vector<PackageFile>, std::string> make() {
    if (const auto error = assign_words()) return unexpected(*error);
    bed_y_ = 150;
    for (const FormulaChain& chain : formula_.chains) {
      bool across = moves_along_y(chain.work);
      for (const FormulaBranch& tool : chain.tools) {
        across = across || moves_along_y(tool);
        bed_y_ = std::max(bed_y_, layer_y(0, tool) + 50);
      }
      if (across) bed_y_ = std::max(bed_y_, 300.0);
    }
    int beside_count = 0;
    for (std::size_t i = 0; i < formula_.chains.size(); ++i) {
      const FormulaChain& chain = formula_.chains[i];
      Place place;
      place.counter = i > 0 && std::all_of(chain.tools.begin(), chain.tools.end(),
                                           [](const FormulaBranch& t) { return t.empty(); });
      if (i > 0 && !place.counter) place.y = -beside * ++beside_count;
      add_work(chain.work, place, i);
      for (std::size_t t = 0; t < chain.tools.size() && !place.counter; ++t)
        add_tool(chain.tools[t], place, i, t);
      if (!place.counter) add_bed(place, i);
    }
    std::vector<PackageFile> files = {{"machine.toml", machine_toml()},
                                      {"tools.toml", tools_toml()}};
    files.insert(files.end(), meshes_.begin(), meshes_.end());
    return files;
  }

 private:
  static bool moves_along_y(const FormulaBranch& branch) {
    return std::any_of(branch.begin(), branch.end(), [](const FormulaCouple& c) {
      return !c.rotary && (c.axis[0] == 'Y' || c.axis[0] == 'V');
    });
  }
  static bool driven(const FormulaCouple& couple) {
    return !couple.axis.empty() && !couple.is_spindle();
  }

  // ---- program words ----

  std::optional<std::string> assign_words() {
    const auto take = [&](const FormulaCouple& couple) -> std::optional<std::string> {
      if (!driven(couple)) return std::nullopt;
      static const std::map<char, std::string> wishes = {
          {'X', "XUVWY"},  {'Y', "YVUW"}, {'Z', "ZWVUY"}, {'U', "UVWXYZ"}, {'V', "VUWYXZ"},
          {'W', "WVUZXY"}, {'A', "ABC"},  {'B', "BCA"},   {'C', "CAB"}};
      for (const char word : wishes.at(couple.axis[0]))
        if (used_.find(word) == used_.npos) {
          used_ += word;
          words_[couple.axis] = word;
          return std::nullopt;
        }
      return "no program word is left for the axis " + couple.axis +
             ": a package has one of X Y Z U V W per slide and one of A B C per turning axis";
    };
    // The way from the first work to the first tool has the first choice.
    std::vector<const FormulaBranch*> branches = {&formula_.chains[0].work,
                                                  &formula_.chains[0].tools[0]};
    for (std::size_t i = 0; i < formula_.chains.size(); ++i) {
      if (i > 0) branches.push_back(&formula_.chains[i].work);
      for (std::size_t t = i == 0 ? 1 : 0; t < formula_.chains[i].tools.size(); ++t)
        branches.push_back(&formula_.chains[i].tools[t]);
    }
    for (std::size_t b = 0; b < branches.size(); ++b)
      for (const FormulaCouple& couple : *branches[b]) {
        if (const auto error = take(couple)) return error;
        if (!driven(couple)) continue;
        if (b < 2 && !couple.rotary && words_[couple.axis] > 'W' &&
            direction_of(words_[couple.axis]) == direction_of(couple.axis[0]))
          continue;
        if (b < 2 && !couple.rotary)
          return "the axis " + couple.axis +
                 " moves the first tool along a direction that another axis has already: a package "
                 "follows one slide each along X, Y and Z there";
        all_on_way_ = all_on_way_ && b < 2;
      }
    if (words_.empty()) return std::string("the formula has no NC axis, so nothing would move");
    return std::nullopt;
  }

  bool is_chain() const {
    return all_on_way_ && used_.find('X') != used_.npos && used_.find('Y') != used_.npos &&
           used_.find('Z') != used_.npos;
  }

  // ---- the tree ----

  struct Axis {
    const FormulaCouple* couple;
    std::string parent, child;
    Vec3 origin, direction;
    double sense;
  };

  std::string add_axis(const FormulaCouple& couple, const std::string& parent, const Vec3& origin,
                       double reversed, double sense) {
    Axis axis{&couple, parent, couple.element, origin, reversed * direction_of(couple.axis[0]),
              sense};
    while (std::any_of(axes_.begin(), axes_.end(),
                       [&](const Axis& a) { return a.child == axis.child; }))
      axis.child += "x";
    axes_.push_back(axis);
    return axis.child;
  }

  // Mesh of a body, seen from bed axes; a counter spindle's is turned about by the caller.
  void add_body(const std::string& name, const std::string& link, const TriangleMesh& mesh,
                const char* color, bool spindle = false) {
    meshes_.push_back({"meshes/" + name + ".stl", stl_bytes(mesh)});
    bodies_ += "\n[[body]]\nname = \"" + name + "\"\nlink = \"" + link + "\"\nmesh = \"meshes/" +
               name + ".stl\"\ncolor = \"" + color + "\"\n" +
               (spindle ? "role = \"spindle\"\n" : "");
  }

  static Pose placed(const Place& place) {
    Pose X = translation(Vec3(0, place.y, 0));
    if (place.counter) {
      // Half a turn about X: the chuck looks back, and Y is mirrored as a real counter spindle's
      // is.
      X.linear() = Eigen::AngleAxisd(3.14159265358979323846, Vec3::UnitX()).toRotationMatrix();
      X.translation() = Vec3(0, 0, counter_z);
    }
    return X;
  }

  void add_work(const FormulaBranch& branch, const Place& place, std::size_t chain) {
    std::string link = "bed";
    const Pose X = placed(place);
    const std::string number = chain == 0 ? "" : std::to_string(chain + 1);
    const auto slides = std::count_if(branch.begin(), branch.end(), [](const FormulaCouple& c) {
      return driven(c) && !c.rotary;
    });
    double back = -130 - 110.0 * static_cast<double>(std::max<long>(slides, 1) - 1);
    bool stands = slides > 0;
    for (const FormulaCouple& couple : branch) {
      if (!driven(couple)) continue;
      const double reversed = place.counter && !couple.rotary ? -1 : 1;
      link = add_axis(couple, link, X.translation(), reversed, -1);
      if (chain == 0 && !turned_) {
        if (couple.rotary && !is_chain())
          turned_ = true;  // without tool centre point control the table does not turn X Y Z
        else
          work_link_ = link;
      }
      if (couple.rotary && &couple != &branch.back())
        add_body("carrier-" + lower(link), link,
                 transformed(revolve({{60, -128}, {60, -122}}, 0.05), X), "#9aa1a6");
      if (couple.rotary) continue;
      add_body("work-slide-" + lower(link), link,
               transformed(make_box(Vec3(-120, -120, back - 100), Vec3(120, 120, back)), X),
               "#7d8f99");
      back += 110;
    }
    if (!stands)
      add_body("headstock" + number, "bed",
               transformed(make_box(Vec3(-120, -120, -230), Vec3(120, 120, -130)), X), "#5f6f73");
    add_body("chuck" + number, link,
             transformed(revolve({{90, -120}, {90, -20}, {60, 0}}, 0.05), X), "#b9bec2");
  }

  static double gap(const FormulaBranch& branch) { return moves_along_y(branch) ? 260 : 50; }
  // Near face of the layer of couple i.
  static double layer_y(std::size_t i, const FormulaBranch& branch) {
    return 80 + gap(branch) * static_cast<double>(branch.size() - std::min(i, branch.size()));
  }

  void add_tool(const FormulaBranch& branch, const Place& place, std::size_t chain,
                std::size_t number) {
    std::string link = "bed";
    const double side = number % 2 ? -1 : 1;
    const std::string suffix =
        (chain || number) ? "-" + std::to_string(chain + 1) + "-" + std::to_string(number + 1) : "";
    const auto box = [&](double x0, double x1, double y0, double y1, double z0, double z1) {
      return make_box(Vec3(std::min(side * x0, side * x1), place.y + y0, gauge_z + z0),
                      Vec3(std::max(side * x0, side * x1), place.y + y1, gauge_z + z1));
    };
    for (std::size_t i = 0; i < branch.size(); ++i) {
      const FormulaCouple& couple = branch[i];
      if (!driven(couple)) continue;
      const bool radial = couple.axis[0] == 'X' || couple.axis[0] == 'U';
      link = add_axis(couple, link, Vec3(0, place.y, gauge_z), radial ? side : 1, 1);
      const double y = layer_y(i, branch);
      if (couple.rotary && i + 1 < branch.size())
        add_body("carrier-" + lower(link), link, box(-30, 30, y, y + 40, 60, 120), "#9aa1a6");
      if (couple.rotary) continue;
      add_body("slide-" + lower(link), link,
               radial ? box(-40, 300, y, y + 40, 30, 150) : box(100, 420, y, y + 40, 20, 260),
               radial ? "#8d9aa1" : "#7d8f99");
    }
    if (chain == 0 && number == 0) tool_link_ = link;
    add_body("turret" + suffix, link, box(-40, 40, -40, 120, 5, 120), "#d9772b",
             chain == 0 && number == 0);
  }

  void add_bed(const Place& place, std::size_t chain) {
    const double y = place.y + bed_y_;
    add_body(chain == 0 ? "bed" : "bed-" + std::to_string(chain + 1), "bed",
             make_box(Vec3(-700, y, -900), Vec3(700, y + 80, counter_z)), "#e4e6e2");
  }

  static std::string lower(std::string text) {
    for (char& c : text)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
  }

  // ---- text ----

  std::string axis_toml(const Axis& axis) const {
    const FormulaCouple& couple = *axis.couple;
    const Range r = range_of(couple.axis[0]);
    std::string text = "\n[[axis]]               # " + couple.axis + " of the formula\nname = \"" +
                       std::string(1, words_.at(couple.axis)) + "\"\nkind = \"" +
                       (couple.rotary ? "rotary" : "linear") + "\"\nparent = \"" + axis.parent +
                       "\"\nchild = \"" + axis.child + "\"\n";
    if (couple.rotary) text += "origin = " + list_of(axis.origin) + "\n";
    text += "direction = " + list_of(axis.direction) + "\nsense = " + shortest(axis.sense) + "\n";
    if (couple.axis[0] != 'C')
      text += "min = " + shortest(r.min) + "\nmax = " + shortest(r.max) + "\n";
    return text + "vmax = " + shortest(r.vmax) + "\namax = " + shortest(r.amax) +
           "\nhome = " + shortest(couple.axis[0] == 'C' ? 0 : r.home) + "\n";
  }

  std::string machine_toml() const {
    std::string coordinates, axes;
    for (const Axis& axis : axes_) {
      coordinates += words_.at(axis.couple->axis);
      axes += axis_toml(axis);
    }
    std::string text =
        "# " + name_ + ": made from the structural formula\n#   " + machine::text_of(formula_) +
        "\n# Travels, speeds and bodies are usual values; put in those of the machine.\n"
        "schema = 1\nname = \"" +
        name_ +
        "\"\nunits = \"mm\"\ndialect = \"linuxcnc\"\ntools = \"tools.toml\"\n\n"
        "[kinematics]\n";
    text += is_chain() ? "type = \"chain\"\n"
                       : "type = \"identity\"\ncoordinates = \"" + coordinates + "\"\n";
    text += "\n# X Y Z of the program with no offset are the joints' values.\n[work]\nlink = \"" +
            work_link_ + "\"\norigin = " + list_of(Vec3(0, 0, gauge_z)) + "\n" + axes +
            "\n[spindle]\nlink = \"" + tool_link_ + "\"\ngauge = " + list_of(Vec3(0, 0, gauge_z)) +
            "\nrpm = [0, 4000]\n\n[toolchange]\ntime = 4.0\n\n[collision]\ntolerance = 0.005\n";
    return text + bodies_;
  }

  static std::string tools_toml() {
    return "# Tools of the machine. Lengths in mm.\nschema = 1\nunits = \"mm\"\n\n[[tool]]\n"
           "number = 1\nname = \"10 mm end mill\"\nkind = \"flat\"\ndiameter = 10.0\n"
           "flute_length = 22.0\nstick_out = 40.0\nshank_diameter = 10.0\n";
  }

  const Formula& formula_;
  std::string name_;
  std::string used_;                   ///< program words
  std::map<std::string, char> words_;  ///< by axis of the formula
  bool all_on_way_ = true;  ///< every NC axis is between the first work and the first tool
  bool turned_ = false;
  double bed_y_ = 0;
  std::vector<Axis> axes_;
  std::string work_link_ = "bed", tool_link_ = "bed", bodies_;
  std::vector<PackageFile> meshes_;
};

}  // namespace

tl::expected<std::vector<PackageFile>, std::string> package_of(const Formula& formula,
                                                               const std::string& name) {
  if (formula.chains.empty()) return unexpected(std::string("the formula is empty"));
  return Package(formula, name).make();
}

}  // namespace aircut::machine
