// The command line as plain values. CLI11 stays in arguments.cpp.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/base.h"

namespace aircut::cli {

enum class Format { human, json, jsonl, gcc, sarif, junit, github };
enum class When { automatic, always, never };

/// What every command that reads a program takes.
struct ProgramArguments {
  std::string program;
  std::string machine;  ///< folder, machine.toml or name
  std::string tools, setup, parameters;
  std::string ini;  ///< set-up of a LinuxCNC machine
  enum class IniUse { both, machine, control } ini_use = IniUse::both;  ///< what of `-m FILE.ini`
  std::vector<std::pair<std::string, double>> set;
  std::vector<std::string> sub_path;
  std::string dialect;  ///< linuxcnc, fanuc, haas, auto; empty: the machine's
  bool whole_units = false;
  bool lathe = false;  ///< --lathe: G-code system A
  bool block_delete = false, optional_stop = false;
  std::optional<unsigned long long> max_blocks;
};

struct OutputArguments {
  Format format = Format::human;
  bool quiet = false;
  When color = When::automatic;
  When progress = When::automatic;
  std::optional<Severity> fail_on = Severity::error;
  std::size_t max_findings = 100;
  bool strict = false;
  std::vector<std::string> waive, raise;  ///< as written
  std::string baseline;                   ///< file
};

/// What pictures show, and from where.
struct ViewArguments {
  std::string camera = "iso";
  std::string section = {};                                ///< --section AXIS=MM; empty: none
  std::vector<std::string> hidden = {}, see_through = {};  ///< bodies, by name or NAME*
};

struct RunArguments {
  ProgramArguments program;           ///< `program` is empty with channels
  std::vector<std::string> channels;  ///< --channel NAME=PROGRAM, as written
  OutputArguments output;
  std::string folder;  ///< -o
  bool force = false;
  std::string log;   ///< --log FILE or `null`; empty: joints.csv in the folder
  std::string part;  ///< --part FILE (.stl, .3mf) or `null`; empty: part.stl and .3mf in the folder
  std::string save_stock;  ///< --save-stock FILE
  std::string overrides;   ///< --overrides FILE
  std::string accuracy;    ///< --accuracy FILE
  double period = 0.001;
  int log_every = 1;
  double near = 2;
  std::vector<std::string> checks;  ///< empty: all
  std::vector<std::string> frames;
  ViewArguments view{.camera = "work"};
  std::string stock_colors = "plain";  ///< or tool
  std::string path_colors = "kind";    ///< or time, none
  int width = 1280, height = 800;
  std::vector<std::string> motion;  ///< forms of the animation
  std::optional<double> max_time;
};

struct JobArguments {
  std::string file;
  std::string folder;  ///< -o
  bool force = false;
  std::vector<std::string> frames;
  OutputArguments output;  ///< of every run
};

struct CheckArguments {
  ProgramArguments program;  ///< `program` unused
  std::vector<std::string> programs;
  std::vector<std::string> checks;  ///< empty: all that are possible
  OutputArguments output;
};

enum class TraceFormat { text, jsonl, rs274 };
struct TraceArguments {
  ProgramArguments program;
  TraceFormat format = TraceFormat::text;
  When color = When::automatic;
};

struct MachineArguments {
  enum class Action { check, info, render, create, convert } action = Action::info;
  std::string machine, setup, tools;
  int tool = 0;
  std::string output = "machine.png";
  ViewArguments view;
  int width = 1280, height = 800;
  bool force = false;
  std::string formula;       ///< create: `machine` is the folder that is written
  std::string package_root;  ///< convert: where `package://` looks
  When color = When::automatic;
};

struct KinArguments {
  enum class Action { fk, ik, jac, sweep, rot } action = Action::ik;
  std::string machine;
  std::optional<int> kinstype;          ///< number of the machine's channel
  std::string type;                     ///< instead of a machine: a kinematics alone
  std::vector<std::string> parameters;  ///< of the type: `radius=120`
  std::vector<std::string> ranges;      ///< sweep: `X=0:500:50`
  bool tool_vector = false;             ///< ik: rows are X Y Z I J K
  // rot:
  std::string from = "XYZ-int", to = "XYZ-int";
  bool frame = false;    ///< rows are POS, the orientation, POS_R
  bool add = false;      ///< each row is a step on top of the one before
  bool inverse = false;  ///< both solutions
  bool cycle = false;    ///< rows are calls of CYCLE600
  When color = When::automatic;
};

struct WorkspaceArguments {
  std::string machine;
  std::string x, y, z;  ///< FROM:TO, one number, or empty: all that can be reached
  std::string a, b;     ///< tilts that each point must allow
  double pitch = 10;
  bool nodes = false, connected = false;
  bool free = false;                ///< only where no bodies touch
  std::string tools;                ///< tool file
  std::string setup;                ///< fixtures and stock
  int tool = 0;                     ///< in the spindle; its tip is what reaches
  int threads = 0;                  ///< 0: one per core
  std::vector<std::string> output;  ///< .csv, .npy, .stl, .png
  bool force = false;
  When color = When::automatic;
};

struct LogArguments {
  enum class Action { check, info, diff, table, plot } action = Action::info;
  std::string file, other;
  ProgramArguments program;  ///< check: may be empty
  std::string output;
  bool header = false;  ///< a table with the header lines
  bool force = false;
  std::vector<std::string> columns;
  unsigned long long every = 1;
  double from = 0, to = 1e300;  ///< s
  double tolerance = 1e-6;
  int width = 1600;
  std::string color_word = "auto";
};

struct AccuracyArguments {
  std::string setup;
  Format format = Format::human;  ///< human or json
  std::string folder;             ///< -o
  bool force = false;
  bool influence = false;          ///< E_kl in the JSON
  std::vector<std::string> sweep;  ///< as written
  std::string of;                  ///< column of the sweep that is drawn
  std::string plot;                ///< PNG file of the sweep
  When color = When::automatic;
};

struct DiffArguments {
  std::string one, two;
  ProgramArguments program;  ///< `program` unused
  double tolerance = 1e-6;
  std::size_t most = 100;
};

struct ExplainArguments {
  std::string kind;
  bool list = false;
};

struct DoctorArguments {};

using Arguments =
    std::variant<RunArguments, JobArguments, CheckArguments, TraceArguments, MachineArguments,
                 KinArguments, WorkspaceArguments, AccuracyArguments, LogArguments, DiffArguments,
                 ExplainArguments, DoctorArguments>;

/// Either what to do, or the exit code when the command line was answered (help, version, usage).
std::variant<Arguments, int> parse(int argc, char** argv);

}  // namespace aircut::cli
