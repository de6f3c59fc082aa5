// The handlers of the code table, one file per subject.
#pragma once

#include "canon/way.h"
#include "interp/contour.h"
#include "interp/run.h"

namespace aircut::interp {

// motion.cpp
void rapid(const CodeRule&, BlockRun&);
void linear_feed(const CodeRule&, BlockRun&);
void cancel_motion(const CodeRule&, BlockRun&);
void thread(const CodeRule&, BlockRun&);
void rigid_tap(const CodeRule&, BlockRun&);
void probe(const CodeRule&, BlockRun&);
// arcs.cpp
void arc(const CodeRule&, BlockRun&);
// splines.cpp
void cubic_spline(const CodeRule&, BlockRun&);
void quadratic_spline(const CodeRule&, BlockRun&);
void nurbs_point(const CodeRule&, BlockRun&);
void nurbs_end(const CodeRule&, BlockRun&);
// cycles.cpp
void canned_cycle(const CodeRule&, BlockRun&);
// fanuc_cycles.cpp
void fanuc_cycle(const CodeRule&, BlockRun&);
void manual_cycle(const CodeRule&, BlockRun&);
void rigid_tapping(const CodeRule&, BlockRun&);
void hole_pattern(const CodeRule&, BlockRun&);
// haas_pockets.cpp
void circular_pocket(const CodeRule&, BlockRun&);
void general_pocket(const CodeRule&, BlockRun&);
// lathe_single.cpp
void single_pass(const CodeRule&, BlockRun&);
void lathe_thread(const CodeRule&, BlockRun&);
void lathe_feed_mode(const CodeRule&, BlockRun&);
void speed_limit(const CodeRule&, BlockRun&);
void lathe_surface_speed(const CodeRule&, BlockRun&);
// lathe_grooving.cpp
void lathe_groove(const CodeRule&, BlockRun&);
void lathe_thread_cycle(const CodeRule&, BlockRun&);
// lathe_roughing.cpp
void lathe_roughing(const CodeRule&, BlockRun&);
// contour_turning.cpp
void contour_turning(const CodeRule&, BlockRun&);
// threading.cpp
void thread_cycle(const CodeRule&, BlockRun&);
// modes.cpp
void select_plane(const CodeRule&, BlockRun&);
void select_unit(const CodeRule&, BlockRun&);
void lathe_mode(const CodeRule&, BlockRun&);
void distance_mode(const CodeRule&, BlockRun&);
void arc_centre_mode(const CodeRule&, BlockRun&);
void feed_mode(const CodeRule&, BlockRun&);
void path_mode(const CodeRule&, BlockRun&);
void retract_mode(const CodeRule&, BlockRun&);
void radius_comp_off(const CodeRule&, BlockRun&);
void radius_comp_on(const CodeRule&, BlockRun&);
void dwell(const CodeRule&, BlockRun&);
// offsets.cpp
void set_data(const CodeRule&, BlockRun&);
void machine_coordinates(const CodeRule&, BlockRun&);
void go_home(const CodeRule&, BlockRun&);
void store_home(const CodeRule&, BlockRun&);
void length_offset(const CodeRule&, BlockRun&);
void work_system(const CodeRule&, BlockRun&);
void local_offset(const CodeRule&, BlockRun&);
void g92(const CodeRule&, BlockRun&);
// fanuc_offsets.cpp
void fanuc_work_system(const CodeRule&, BlockRun&);
void local_shift(const CodeRule&, BlockRun&);
void coordinate_shift(const CodeRule&, BlockRun&);
void preset_work_system(const CodeRule&, BlockRun&);
void fanuc_data(const CodeRule&, BlockRun&);
void set_lathe_offset(const CodeRule&, BlockRun&);
void data_end(const CodeRule&, BlockRun&);
// fanuc_tools.cpp
void fanuc_length_offset(const CodeRule&, BlockRun&);
void switch_kinematics(const CodeRule&, BlockRun&, int model);
void fanuc_radius_comp(const CodeRule&, BlockRun&);
void fanuc_change_tool(const CodeRule&, BlockRun&);
// fanuc_reference.cpp
void fanuc_machine_coordinates(const CodeRule&, BlockRun&);
void fanuc_home(const CodeRule&, BlockRun&);
void return_from_home(const CodeRule&, BlockRun&);
void check_home(const CodeRule&, BlockRun&);
void skip_move(const CodeRule&, BlockRun&);
// fanuc_modes.cpp
void fanuc_dwell(const CodeRule&, BlockRun&);
void fanuc_path_mode(const CodeRule&, BlockRun&);
void accepted(const CodeRule&, BlockRun&);
void builder_code(const CodeRule&, BlockRun&);
void fanuc_orient(const CodeRule&, BlockRun&);
void fanuc_end(const CodeRule&, BlockRun&);
// frames.cpp: Fanuc
void scaling(const CodeRule&, BlockRun&);
void mirror_image(const CodeRule&, BlockRun&);
void rotation_on(const CodeRule&, BlockRun&);
void rotation_off(const CodeRule&, BlockRun&);
// fanuc_polar.cpp
void polar_mode(const CodeRule&, BlockRun&);
// spindle.cpp
void spindle_mode(const CodeRule&, BlockRun&);
void spindle_turn(const CodeRule&, BlockRun&);
void spindle_orient(const CodeRule&, BlockRun&);
// rotary.cpp
/// What the machine's set-up says about rotary axes (wrapped, clamped) for the move of the line to
/// `end`; false with an error.
bool apply_rotary_rules(BlockRun& run, AxisValues& end);
/// The same for a stored machine position, which no word names: the wrapped axes of `axes`.
bool wrap_stored(BlockRun& run, AxisValues& end, AxisSet axes);
/// True when a word of the line names a clamped axis.
bool turns_indexer(const BlockRun& run);
/// A rapid that first turns the clamped axes, one by one.
void rapid_with_indexers(BlockRun& run, const AxisValues& end, const std::string& what);
/// Between these two the path mode is exact path.
void begin_exact_path(BlockRun& run);
void end_exact_path(BlockRun& run);
// tool_change.cpp
void change_tool(const CodeRule&, BlockRun&);
void set_tool_number(const CodeRule&, BlockRun&);
// io.cpp
void coolant(const CodeRule&, BlockRun&);
void override_switch(const CodeRule&, BlockRun&);
void digital_output(const CodeRule&, BlockRun&);
void analog_output(const CodeRule&, BlockRun&);
void wait_input(const CodeRule&, BlockRun&);
void user_code(const CodeRule&, BlockRun&);
// macro_calls.cpp: programs of Fanuc-like controls
void call_program(const CodeRule&, BlockRun&);
void call_local_sub(const CodeRule&, BlockRun&);
void return_from_program(const CodeRule&, BlockRun&);
void call_macro(const CodeRule&, BlockRun&);
void end_modal_macro(const CodeRule&, BlockRun&);
void call_macro_per_block(const CodeRule&, BlockRun&);
/// G66.1: #1-#33 of its macro from the block's `macro_words`. False when one can't be an argument.
bool take_block_as_arguments(BlockRun&);
// program.cpp
void program_stop(const CodeRule&, BlockRun&);
void program_end(const CodeRule&, BlockRun&);
void call_fanuc(const CodeRule&, BlockRun&);
void return_fanuc(const CodeRule&, BlockRun&);
void modal_stack(const CodeRule&, BlockRun&);

// ---- words with a phase of their own
void feed_word(BlockRun&);
void speed_word(BlockRun&);
void tool_word(BlockRun&);
/// T of a Fanuc-like lathe: tool and offset.
void lathe_tool_word(BlockRun&);

// ---- shared by several files
/// The spindle of the `$` word: its index, or `otherwise` without the word. An error when the
/// machine has no such spindle.
std::optional<int> spindle_of(BlockRun& run, int otherwise);
/// The tip position that the axis words mean, or nothing with an error.
std::optional<AxisValues> target_of(BlockRun& run);
/// Moves the point (program coordinates) to where @ and ^ put it; false with an error.
bool apply_polar(BlockRun& run, double& x, double& y);
/// G16: moves the point (program coordinates) to where radius and angle put it, seen from `from`;
/// false with an error.
bool place_polar(BlockRun& run, const AxisValues& from, AxisValues& program);
/// False with an error when the line's words could be polar, and nobody knows.
bool polar_is_off(BlockRun& run, const CodeRule& rule);
/// Centre of the arc that I J K or R of the line mean, in the axes of the plane and program
/// coordinates, or nothing with an error. `rule` is that of G2 or G3.
std::optional<PlanePoint> arc_centre(BlockRun& run, const CodeRule& rule, PlanePoint start,
                                     PlanePoint end);
/// Fanuc: whether the word counts something in the cycle of the line, so that it is no length.
bool is_count_of_cycle(const BlockRun& run, char letter);
/// Fanuc: seconds of a dwell word in milliseconds.
double dwell_seconds(const BlockRun& run, char letter);
/// True when the spindle turns; else the error is recorded.
bool spindle_turns(BlockRun& run, const CodeRule& rule, int spindle);
/// The F of the state as a command.
void emit_feed(BlockRun& run);
/// True when a feed is set for the move; else the error is recorded.
bool feed_is_set(BlockRun& run, const CodeRule& rule);
/// In inverse time the control takes the rate of a move, per minute, for the feed from then on.
/// Gives that rate in mm/s or rad/s; 0 in other modes.
double note_inverse_time(BlockRun& run, canon::Way way);
/// Tell the path mode in force, and Q of G64.
void emit_path_mode(BlockRun& run);
void emit_naive_tolerance(BlockRun& run);
/// D of G96 when it is not given, rev/min.
constexpr double no_css_limit = 1e30;
/// Makes `next`'s settings of work system `system` the ones in force, from the parameters.
void load_work_system(BlockRun& run, int system);
/// Turns radius compensation on; a radius below 0 changes the side.
void start_compensation(const CodeRule& rule, BlockRun& run, CompSide side, double radius,
                        int orientation);
/// A rapid to the machine position that the parameters keep (#5161…, #5181…): of `axes`, or of all
/// when there are none.
void go_to_stored(BlockRun& run, int first_number, AxisSet axes, const std::string& what);
/// Sets the length offset in force; the controlled point stays where it is.
/// `tool`: whose length it is; 0 when it is not a tool's.
void use_length_offset(BlockRun& run, const AxisValues& offset, int tool = 0);
/// False with an error when the first move behind G68 or G69 can't be made so; fills in what the
/// control takes from before G68. `program` is the target, `named` the axes with a word.
bool first_move_in_frame(BlockRun& run, AxisSet named, AxisValues& program);
/// False with an error when a drilling cycle can't be made in the program's frame.
bool frame_allows_cycle(BlockRun& run, const CodeRule& rule);
/// True when the letter's word on this line is a mere number: Q of G10 (an orientation) and G5.1.
bool is_plain_number(const BlockRun& run, char letter);
/// A warning when a frame or G16 is on at this code (M6, M30).
void tell_frames_left_on(const CodeRule& rule, BlockRun& run);
/// Takes back mirror image, scaling, rotation and polar coordinates (M30).
void reset_frames(BlockRun& run);
/// True when no frame of the program acts on these axes; else the error is recorded.
bool frame_allows(BlockRun& run, const CodeRule& rule, AxisSet axes);
/// The number of a word whose digits without a point count thousandths, whatever the unit: angles,
/// factors, seconds.
double thousandths(const BlockRun& run, const Word& word);
/// G40, or G41 or G42 with the tool in the spindle.
void restore_radius_comp(BlockRun& run, CompSide side);
/// Emits the commands that bring a listener from `from` to `to` (M72 and returns of M73).
void restore_state(BlockRun& run, const ModalState& saved);

}  // namespace aircut::interp
