// `aircut kin rot`: orientations as three angles in any convention, as a matrix, as the frame of a
// rotation cycle, or as the angles of a milling head and a turntable.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cli/exit_code.h"
#include "cli/job.h"
#include "cli/rows.h"
#include "machine/rotation/cycle600.h"
#include "machine/rotation/head.h"

namespace aircut::cli {

namespace {

using machine::RotationConvention;

constexpr double degree = std::numbers::pi / 180;

/// What a row is read as, or written as.
struct Form {
  enum class Kind { angles, all, matrix, head, table } kind = Kind::angles;
  RotationConvention convention;
  machine::TwoAxisHead head;
};

tl::expected<Form, std::string> form_of(const std::string& name) {
  Form form;
  if (name == "matrix") {
    form.kind = Form::Kind::matrix;
    return form;
  }
  const auto convention = machine::convention_of_name(name);
  if (!convention) return unexpected(convention.error() + " 'matrix' stands for nine numbers.");
  form.convention = *convention;
  return form;
}

tl::expected<Form, std::string> output_form(const std::string& name) {
  Form form;
  if (name == "all") form.kind = Form::Kind::all;
  if (name == "head" || name == "head45") form.kind = Form::Kind::head;
  if (name == "table" || name == "table45") form.kind = Form::Kind::table;
  if (form.kind == Form::Kind::angles) return form_of(name);
  if (name.ends_with("45")) form.head.u2 = machine::nutating_axis();
  return form;
}

std::vector<Column> columns_of(const Form& form, bool frame) {
  std::vector<Column> columns;
  if (form.kind == Form::Kind::matrix)
    for (const char* name : {"R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33"})
      columns.push_back({name, 1});
  else
    for (const char* name : {"ANG_1", "ANG_2", "ANG_3"}) columns.push_back({name, degree});
  if (!frame) return columns;
  for (const char* name : {"POS_X_R", "POS_Y_R", "POS_Z_R"}) columns.push_back({name, 1});
  for (const char* name : {"POS_Z", "POS_Y", "POS_X"}) columns.insert(columns.begin(), {name, 1});
  return columns;
}

Vec3 vector_at(const Row& row, std::size_t at) { return {row[at], row[at + 1], row[at + 2]}; }

Row row_of(const Vec3& v, double unit = 1) { return {v[0] / unit, v[1] / unit, v[2] / unit}; }

TextOrReason head_text(const Form& form, const Mat3& R) {
  std::vector<Row> rows;
  for (const machine::HeadAngles& h : machine::head_angles(form.head, R.col(2))) {
    const Mat3 reached = machine::tip_on_head(form.head, h, 0).linear();
    rows.push_back({h.c / degree, h.a / degree, machine::residual_roll(R, reached) / degree});
  }
  if (rows.empty()) return unexpected(std::string("the head can't point the tool there"));
  return text_of_all(rows);
}

TextOrReason table_text(const Form& form, const Mat3& R) {
  machine::TableAndHead both;
  both.head = form.head;
  const auto at = machine::turn_least(both, R.col(2), {});
  if (!at) return unexpected(std::string("table and head together can't point the tool there"));
  return text_of({at->t / degree, at->head.c / degree, at->head.a / degree});
}

TextOrReason orientation_text(const Form& form, const Mat3& R, bool inverse) {
  const auto angles = [&](const RotationConvention& convention) {
    const Vec3 first = machine::angles_of(convention, R).angles;
    std::vector<Row> rows = {row_of(first, degree)};
    if (inverse) rows.push_back(row_of(machine::other_angles(first), degree));
    return text_of_all(rows);
  };
  switch (form.kind) {
    case Form::Kind::matrix: {
      Row row;
      for (int i = 0; i < 9; ++i) row.push_back(R(i / 3, i % 3));
      return text_of(row);
    }
    case Form::Kind::head:
      return head_text(form, R);
    case Form::Kind::table:
      return table_text(form, R);
    case Form::Kind::all: {
      std::string line;
      for (const RotationConvention& c : machine::rotation_conventions())
        line += (line.empty() ? "" : " ; ") + machine::name_of(c) + " " + angles(c);
      return line;
    }
    case Form::Kind::angles:
      break;
  }
  return angles(form.convention);
}

// A row as a step of a cycle; a matrix is taken as its angles in `convention`.
tl::expected<machine::RotationStep, std::string> step_of(const Form& from, const Row& row,
                                                         bool frame) {
  machine::RotationStep step;
  step.convention = from.convention;
  const std::size_t at = frame ? 3 : 0;
  std::size_t end = at + 3;
  if (from.kind == Form::Kind::matrix) {
    Mat3 R;
    for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = row[at + static_cast<std::size_t>(i)];
    if (const auto reason = machine::why_no_rotation(R)) return unexpected(*reason);
    step.angles = machine::angles_of(step.convention, R).angles;
    end = at + 9;
  } else {
    step.angles = vector_at(row, at) * degree;
  }
  if (frame) {
    step.before = vector_at(row, 0);
    step.after = vector_at(row, end);
  }
  return step;
}

std::string cycle_text(const machine::Cycle600& call, const machine::Cycle600Result& result) {
  const Row angles = row_of(result.angles.angles, degree);
  return printable(call.head) + " " + text_of(angles) + " " +
         std::to_string(call.out.intrinsic ? 1 : 0) + " " +
         std::to_string(machine::bin_of(call.out)) + " ; " +
         text_of(row_of(result.frame.translation()));
}

}  // namespace

int rot_command(const KinArguments& a) {
  const auto fail = [&](const Diagnostic& d) {
    print_error(d, a.color);
    return code(ExitCode::unknown);
  };
  const auto from = form_of(a.from);
  if (!from) return fail(make_error("usage", "--from: " + from.error()));
  const auto to = output_form(a.to);
  if (!to) return fail(make_error("usage", "--to: " + to.error()));
  if (a.cycle && (a.from != "XYZ-int" || a.to != "XYZ-int" || a.frame || a.add || a.inverse))
    return fail(make_error("usage",
                           "the rows of --cycle say themselves what --from, --to, "
                           "--frame, --add and --inverse say"));
  SourceMap sources;
  const auto input = open_program(sources, "-");
  if (!input) return fail(input.error());
  Pose frame = Pose::Identity();
  if (a.cycle)
    return answer_rows((*input)->content(), "the 18 arguments of CYCLE600", a.color,
                       [&](std::string_view line) -> TextOrReason {
                         const auto call = machine::read_cycle600(line);
                         if (!call) return unexpected(call.error());
                         const auto result = run(*call, frame);
                         frame = result.frame;
                         return cycle_text(*call, result);
                       });
  const auto columns = columns_of(*from, a.frame);
  return answer_rows(
      (*input)->content(), names_of(columns), a.color, [&](std::string_view line) -> TextOrReason {
        const auto row = read_row(line, columns);
        if (!row) return unexpected(row.error());
        const auto step = step_of(*from, *row, a.frame);
        if (!step) return unexpected(step.error());
        const Pose next = a.add ? machine::added(frame, *step) : machine::frame_of(*step);
        frame = next;
        const auto text = orientation_text(*to, next.linear(), a.inverse);
        if (!text || !a.frame) return text;
        return text_of(row_of(next.translation())) + " ; " + *text;
      });
}

}  // namespace aircut::cli
