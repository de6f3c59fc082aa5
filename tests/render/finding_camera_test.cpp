#include "render/finding_camera.h"

#include "render/scenes.h"

namespace aircut::render {
namespace {

// Two small blocks that touch at the origin, inside a box that is open at one side only.
std::vector<DrawBody> niche(const Vec3& open_side) {
  std::vector<DrawBody> out = {body("left", block(20, 20, 20), Vec3(-10, 0, 0)),
                               body("right", block(20, 20, 20), Vec3(10, 0, 0))};
  out[0].highlight = out[1].highlight = true;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      Vec3 at = Vec3::Zero(), size = Vec3::Constant(200);
      at[axis] = sign * 100;
      size[axis] = 4;
      if (at.normalized() == open_side) continue;
      out.push_back(body("wall", block(size.x(), size.y(), size.z()), at));
    }
  return out;
}

TEST(FindingCamera, LooksInWhereTheContactIsOpenToSight) {
  for (const Vec3& side :
       {Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1)}) {
    const auto bodies = niche(side);
    const Camera camera = camera_for_finding(bodies, Vec3::Zero(), 80, 1.6);
    EXPECT_GT((camera.eye - camera.target).normalized().dot(side), 0.5) << side.transpose();
    EXPECT_EQ(camera.target, Vec3::Zero());
    const auto counts = renderer(320, 200).visible_pixels(bare_scene(bodies), camera);
    EXPECT_GT(counts.at(0), 300) << side.transpose();
    EXPECT_GT(counts.at(1), 300) << side.transpose();
  }
}

TEST(FindingCamera, IsTheSameFromARendererThatIsThereAlready) {
  const auto bodies = niche(Vec3(1, 0, 0));
  const Camera own = camera_for_finding(bodies, Vec3::Zero(), 80, 1.6);
  Renderer r = renderer(320, 200);
  const Camera shared = r.camera_for_finding(bodies, Vec3::Zero(), 80);
  EXPECT_LT((own.eye - shared.eye).norm(), 1e-9);
}

TEST(FindingCamera, HoldsTheSpanInTheSmallerSide) {
  for (const double aspect : {0.5, 1.0, 2.0}) {
    const Camera camera = contact_camera(Vec3(1, 2, 3), Vec3(0, -1, 0), 100, aspect);
    const double vertical =
        2 * (camera.eye - camera.target).norm() * std::tan(camera.field_of_view / 2);
    EXPECT_NEAR(std::min(vertical, vertical * aspect), 100, 1e-9);
  }
}

TEST(FindingCamera, PrefersBothBodiesToMoreOfOne) {
  std::vector<DrawBody> bodies(2);
  bodies[0].highlight = bodies[1].highlight = true;
  ContactView one{20, 20, std::vector<int>(400, 1), true};
  ContactView both = one;
  for (std::size_t i = 0; i < 400; ++i) both.ids[i] = i % 20 < 4 ? 1 : i % 20 > 15 ? 2 : 0;
  EXPECT_GT(contact_score(both, bodies), contact_score(one, bodies));
  ContactView hidden = both;
  hidden.point_is_open = false;
  EXPECT_GT(contact_score(both, bodies), contact_score(hidden, bodies));
  ContactView behind = both;
  behind.cover = 0.3;
  EXPECT_GT(contact_score(both, bodies), contact_score(behind, bodies));
  ContactView blocked = both;
  blocked.foreground = 0.5;
  EXPECT_GT(contact_score(both, bodies), contact_score(blocked, bodies));
  ContactView nothing{20, 20, std::vector<int>(400, 0), true};
  EXPECT_EQ(contact_score(nothing, bodies), 0);
}

TEST(FindingCamera, GivesSomeViewWhenNothingCanBeSeen) {
  const Camera camera = camera_for_finding({}, Vec3(5, 6, 7), 50, 1.6);
  EXPECT_EQ(camera.target, Vec3(5, 6, 7));
  EXPECT_TRUE(camera.eye.allFinite());
}

}  // namespace
}  // namespace aircut::render
