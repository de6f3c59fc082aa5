// Numbered, named and predefined parameters, with a journal so that a block that fails leaves no
// trace. Values are kept as the program sees them: machine units for the offsets' numbers.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interp/expression.h"

namespace aircut::interp {

/// First numbers of the groups that the interpreter itself reads and writes.
namespace number {
constexpr int absolute_position = 5021;
constexpr int probe_position = 5061;
constexpr int probe_tripped = 5070;
constexpr int length_offset = 5081;
constexpr int g28_position = 5161;
constexpr int g30_position = 5181;
constexpr int g92_applied = 5210;
constexpr int g92_offset = 5211;
constexpr int active_system = 5220;
constexpr int first_system = 5221;  ///< + 20 per system; the tenth is the rotation in degrees
constexpr int input_result = 5399;
constexpr int loaded_tool = 5400;
constexpr int tool_offset = 5401;
constexpr int tool_diameter = 5410;
constexpr int current_position = 5420;
constexpr int debug_enabled = 5599;
constexpr int last = 5601;
}  // namespace number

/// The pin that tells the number of the kinematics in force.
constexpr std::string_view kinematics_pin = "_hal[motion.switchkins-type]";

/// Values that follow from the state of the machine and not from a setting.
class LiveValues {
 public:
  virtual ~LiveValues() = default;
  /// Of a read-only number (5021…, 5081…, 5400…, 5420…); nothing with a fault while not readable.
  virtual std::optional<double> numbered(int number, Place place,
                                         std::optional<Fault>& fault) const = 0;
  /// Of a predefined name (index in predefined_names()).
  virtual double predefined(int index) const = 0;
  /// Of a system variable of macro B (#1000…); nothing with a fault when there is none.
  virtual std::optional<double> system_variable(int, Place, std::optional<Fault>&) const {
    return std::nullopt;
  }
  /// Least increments in a unit of length: 1000 per mm, 10000 per inch.
  virtual double increments_per_unit() const { return 1000; }
};

const std::vector<std::string>& predefined_names();

class Parameters {
 public:
  /// `ini`: SECTION/KEY → value, by which #<_ini[section]key> is found in capitals.
  /// `macro_b`: variables of Fanuc-like controls, vacant until they are set.
  Parameters(const LiveValues& live, std::map<std::string, double> ini, bool macro_b = false,
             bool hal_pins = true);

  // ---- numbered
  static bool in_range(int n) { return n >= 1 && n <= number::last; }
  static bool read_only(int n);
  /// True for the numbers that are nothing but stored: they can be read and set at any time.
  static constexpr bool always_readable(int n) { return n >= 1 && n < number::absolute_position; }
  std::optional<double> read(int n, Place place, std::optional<Fault>& fault) const {
    if (n >= 1 && n < first_computed_) return values_[static_cast<std::size_t>(n)];
    return read_high(n, place, fault);
  }
  /// A stored value, for numbers that are not computed.
  double stored(int n) const { return values_[static_cast<std::size_t>(n)]; }
  void write(int n, double value);
  /// Without a way back.
  void write_for_good(int n, double value) { values_[static_cast<std::size_t>(n)] = value; }

  /// Variables of macro B that a program may use for what it likes.
  static bool is_macro_variable(int n) {
    return (n >= 1 && n <= macro_locals) || (n >= 100 && n < 200) || (n >= 500 && n < 1000);
  }
  static constexpr int macro_locals = 33;
  static constexpr int first_system = 1000;  ///< of the system variables
  double increments_per_unit() const { return live_.increments_per_unit(); }

  // ---- named
  std::int32_t intern(std::string_view name);
  const std::string& name_of(std::int32_t id) const;
  std::optional<double> read_named(std::int32_t id, Place place, std::optional<Fault>& fault) const;
  bool exists(std::int32_t id) const;
  bool read_only_name(std::int32_t id) const;
  /// Pins of the machine are given by the user, not by the program.
  bool settable_from_outside(std::int32_t id) const;
  bool too_many_names() const { return names_.size() > 100'000; }
  void write_named(std::int32_t id, double value);
  /// The id when the name is known, without interning it.
  std::optional<std::int32_t> known(std::string_view name) const;

  // ---- calls
  /// A new level of local names. With `arguments`, #1… are filled from them and the rest of
  /// #1-#30 is 0 until the level ends; without, #1-#30 are shared (M98).
  void enter(const std::vector<double>* arguments);
  /// A level of macro B: `locals` are its #1-#33, those of the caller come back at its end.
  void enter_macro(const std::vector<double>& locals);
  void leave();

  /// The result of M66 was read at some time.
  bool input_was_read() const { return input_read_; }
  /// Of a pin that the machine itself knows.
  void write_pin(std::string_view name, double value);

  // ---- transactions
  void commit() { journal_.clear(); }
  void roll_back();

 private:
  enum class NameKind : unsigned char { local, global, predefined, ini, pin };
  struct Name {
    std::string text;
    NameKind kind = NameKind::local;
    int index = 0;         ///< of a predefined name
    bool defined = false;  ///< global or ini
    double value = 0;
  };
  struct Level {
    std::vector<std::pair<std::int32_t, double>> locals;
    std::size_t saves = 0;  ///< how many of #1… come back
    std::array<double, macro_locals> saved{};
  };
  struct Change {
    std::int32_t id = 0;  ///< a number, or -1 - name
    bool defined = true;
    double value = 0;
  };

  std::optional<double> read_high(int n, Place place, std::optional<Fault>& fault) const;
  std::size_t place_of(std::int32_t id) const;
  const double* local(std::int32_t id) const;
  void set_named(std::int32_t id, bool defined, double value);

  const LiveValues& live_;
  bool macro_b_ = false;
  mutable bool input_read_ = false;
  int first_computed_ = number::absolute_position;  ///< below are stored values
  std::map<std::string, double> ini_;
  bool hal_pins_ = true;
  std::vector<double> values_;
  std::vector<Name> names_;
  std::map<std::string, std::int32_t, std::less<>> ids_;
  std::vector<Level> levels_;
  std::vector<Change> journal_;
};

}  // namespace aircut::interp
