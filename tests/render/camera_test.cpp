#include "render/camera.h"

#include "render/scenes.h"

namespace aircut::render {
namespace {

TEST(Camera, ShowsTheWholeBoxFromEveryNamedSide) {
  const Box3 box(Vec3(-300, 20, -50), Vec3(450, 140, 900));
  for (const char* name : {"iso", "front", "back", "left", "right", "top"})
    for (const int width : {300, 800, 2000}) {
      constexpr int height = 800;
      const auto camera = camera_by_name(name, box, static_cast<double>(width) / height);
      ASSERT_TRUE(camera);
      const View view = make_view(*camera, box, width, height);
      double nearest = 1e9;
      for (const Vec3& corner : corners(box)) {
        const auto p = view.pixel(corner);
        ASSERT_TRUE(p) << name;
        nearest = std::min(
            {nearest, p->x() / width, p->y() / height, 1 - p->x() / width, 1 - p->y() / height});
      }
      EXPECT_GT(nearest, 0.04) << name << ' ' << width;  // a margin, but no more than needed
      EXPECT_LT(nearest, 0.10) << name << ' ' << width;
    }
}

TEST(Camera, HasTheMachineTheRightWayUp) {
  const Box3 box(Vec3(-10, -10, -10), Vec3(10, 10, 10));
  struct Row {
    const char* name;
    Vec3 to_the_right, upwards;
  };
  for (const Row& row :
       {Row{"front", Vec3::UnitX(), Vec3::UnitZ()}, Row{"back", -Vec3::UnitX(), Vec3::UnitZ()},
        Row{"right", Vec3::UnitY(), Vec3::UnitZ()}, Row{"left", -Vec3::UnitY(), Vec3::UnitZ()},
        Row{"top", Vec3::UnitX(), Vec3::UnitY()}}) {
    const View view = make_view(*camera_by_name(row.name, box, 1), box, 400, 400);
    const auto middle = view.pixel(Vec3::Zero()), right = view.pixel(row.to_the_right),
               up = view.pixel(row.upwards);
    EXPECT_GT(right->x(), middle->x() + 1) << row.name;
    EXPECT_LT(up->y(), middle->y() - 1) << row.name;
  }
}

TEST(Camera, TakesEyeAndTargetAsSixNumbers) {
  const auto camera = camera_by_name("10,-200,30.5,1,2,3", Box3(), 1);
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->eye, Vec3(10, -200, 30.5));
  EXPECT_EQ(camera->target, Vec3(1, 2, 3));
  const auto down = camera_by_name("0,0,100,0,0,0", Box3(), 1);
  ASSERT_TRUE(down);
  EXPECT_EQ(down->up, Vec3::UnitY());
}

TEST(Camera, RefusesAnUnknownNameAndNamesTheNearest) {
  const auto wrong = camera_by_name("frunt", Box3(), 1);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().kind, "usage");
  EXPECT_NE(wrong.error().message.find("'front'"), std::string::npos) << wrong.error().message;
  for (const char* text :
       {"", "1,2,3", "1,2,3,4,5,6,7", "1,2,3,4,5,x", "1,2,3,1,2,3", "nan,0,0,1,1,1"})
    EXPECT_FALSE(camera_by_name(text, Box3(), 1)) << text;
}

TEST(Camera, TurnsDepthsBackIntoDistances) {
  const Box3 box(Vec3(-100, -100, -100), Vec3(100, 100, 100));
  Camera camera;
  camera.eye = Vec3(0, -500, 0);
  for (const double field_of_view : {0.5, 0.0}) {
    camera.field_of_view = field_of_view;
    camera.height = 200;
    const View view = make_view(camera, box, 400, 300);
    for (const double y : {-90.0, 0.0, 75.0})
      EXPECT_NEAR(view.distance_of(view.depth(Vec3(10, y, 20))), 500 + y, 1e-6);
  }
}

TEST(Camera, FitsABoxWithoutSize) {
  for (const Box3& box : {Box3(), Box3(Vec3(5, 5, 5), Vec3(5, 5, 5))}) {
    const auto camera = camera_by_name("iso", box, 1.5);
    ASSERT_TRUE(camera);
    EXPECT_TRUE(camera->eye.allFinite());
    EXPECT_GT((camera->eye - camera->target).norm(), 0);
  }
}

}  // namespace
}  // namespace aircut::render
