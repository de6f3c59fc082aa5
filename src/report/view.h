// How pictures of a run or of a machine look at it: from where, what is left out, what is cut open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "machine/machine.h"
#include "render/render.h"

namespace aircut::report {

struct View {
  /// A name of render::camera_by_name, fitted to all that is drawn; `fit=BODY`: the direction of
  /// `iso`, fitted to the bodies that BODY names; of a run also `work` (the work and the tool) and
  /// `tool` (follows its tip).
  std::string camera = "iso";
  /// Bodies not drawn, and drawn translucent: names, or their beginning and a `*`.
  std::vector<std::string> hidden, see_through;
  /// A plane of the work's frame M; what stands before it, as the camera sees it, is cut away.
  struct Section {
    Vec3 normal = Vec3::UnitX();
    double at = 0;  ///< mm along the normal
  };
  std::optional<Section> section;

  bool hides(const std::string& body) const;
  /// Takes the hidden ones away, makes others translucent.
  void select(std::vector<render::DrawBody>& bodies) const;
  /// A camera that does not depend on a moment of a run: not `work`, not `tool`. Error kind
  /// `usage`.
  Expected<render::Camera> fitted_camera(const std::vector<render::DrawBody>& bodies,
                                         double aspect) const;
  /// X_WM: the work's frame in the world.
  void cut_open(render::Scene& drawn, const Pose& X_WM, const render::Camera& camera) const;
};

/// `X=12.5`, `Y=…` or `Z=…`. Error kind `usage`.
Expected<View::Section> section_of(const std::string& text);
/// Error kind `usage` when there is no such camera.
Expected<void> check_camera(const std::string& name);
/// Error kind `usage` when a name is that of no body of the machine or of a tool.
Expected<void> check_view(const machine::Machine& machine, const View& view);

}  // namespace aircut::report
