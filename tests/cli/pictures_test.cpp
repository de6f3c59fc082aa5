// What `run` can be asked to show, and the film that another program makes of it.
#include "cli/program.h"

namespace aircut {
namespace {

namespace fs = std::filesystem;

class Pictures : public Program {
 protected:
  Outcome run(const std::string& more) {
    const bool sized = more.find("--size") != std::string::npos;
    return aircut(
        "run programs/holder-into-vise.ngc -m mill3 --check limits --log null --force -o " +
        path("out") + (sized ? " " : " --size 160x120 ") + more);
  }
  // A PATH that holds nothing but `timeout`, which the tests use, and what is put there as ffmpeg.
  void only_ffmpeg(const std::string& script) {
    fs::create_directories(path("bin"));
    std::error_code error;
    fs::create_symlink("/usr/bin/timeout", path("bin/timeout"), error);
    if (!script.empty()) {
      put("bin/ffmpeg", "#!/bin/sh\n" + script);
      fs::permissions(path("bin/ffmpeg"), fs::perms::owner_all);
    }
    environment_ = "PATH=" + path("bin");
  }
  std::vector<std::string> files() const {
    std::vector<std::string> out;
    for (const auto& item : fs::directory_iterator(path("out")))
      out.push_back(item.path().filename().string());
    return out;
  }
  bool has(const std::string& part) const {
    for (const std::string& name : files())
      if (name.find(part) != std::string::npos) return true;
    return false;
  }
};

TEST_F(Pictures, AreRefusedBeforeTheRunWhenTheyCannotBeMade) {
  const std::pair<const char*, const char*> rows[] = {
      {"--section Q=1", "write X, Y or Z"},
      {"--section X=", "write X, Y or Z"},
      {"--hide colum", "no such body"},
      {"--see-through 'dor*'", "no such body"},
      {"--stock-colors tool", "needs a stock"},
      {"--stock-colors red", "plain"},
      {"--path-colors red", "time"},
      {"--camera nowhere", "there is no camera"},
      {"--camera fit=vize", "no such body"},
      {"--size 0x0", "from 16 to 8192"},
      {"--frames none --motion mp4", "show the frames"},
  };
  for (const auto& [option, words] : rows) {
    const Outcome outcome = run(option);
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_TRUE(outcome.says(words)) << option << "\n" << outcome.err;
    EXPECT_FALSE(fs::exists(path("out/result.json")));
  }
}

TEST_F(Pictures, CanBeCutOpenAndLackBodies) {
  const auto picture = [&](const std::string& options) {
    const Outcome outcome = run("--frames at=13 " + options);
    EXPECT_LE(outcome.code, 1) << outcome.err;
    return text_of(path("out/frames/t00013.000.png"));
  };
  const std::string plain = picture("");
  const std::string cut = picture("--section X=0"), through = picture("--see-through 'vise*'");
  const std::string follows = picture("--hide 'vise*' --camera tool");
  const std::string by_time = picture("--path-colors time"), bare = picture("--path-colors none");
  ASSERT_GT(plain.size(), 1000u);
  for (const std::string* other : {&cut, &through, &follows, &by_time, &bare})
    EXPECT_NE(*other, plain);
  EXPECT_NE(by_time, bare);
  EXPECT_NE(through, follows);
}

TEST_F(Pictures, OfAMachineCanBeCutOpenAndLackBodiesAndFitOne) {
  std::vector<std::string> seen;
  const auto picture = [&](const std::string& more) {
    const Outcome outcome =
        aircut("machine render -m mill3 --size 160x120 --force -o " + path("m.png") + " " + more);
    EXPECT_EQ(outcome.code, 0) << more << "\n" << outcome.err;
    return text_of(path("m.png"));
  };
  for (const char* more :
       {"", "--section X=0", "--see-through 'vise*'", "--hide 'vise*'", "--camera 'fit=vise*'"})
    for (seen.push_back(picture(more)); const std::string& other : seen)
      if (&other != &seen.back()) {
        EXPECT_NE(other, seen.back()) << more;
      }
  for (const auto& [more, words] :
       {std::pair("--hide colum", "no such body"), std::pair("--camera tool", "of a run"),
        std::pair("--section Z", "write X, Y or Z")}) {
    const Outcome outcome =
        aircut("machine render -m mill3 -o " + path("no.png") + " " + std::string(more));
    EXPECT_EQ(outcome.code, 2) << more;
    EXPECT_TRUE(outcome.says(words)) << outcome.err;
    EXPECT_FALSE(fs::exists(path("no.png")));
  }
}

TEST_F(Pictures, BecomeAFilmThroughFfmpeg) {
  only_ffmpeg("for last; do :; done\n/bin/cat > \"$last\"\n");
  const Outcome outcome = run("--frames count=3 --motion mp4");
  EXPECT_LE(outcome.code, 1) << outcome.err;
  const std::string film = text_of(path("out/motion.mp4"));
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = film.find("\x89PNG", at)) != std::string::npos; ++at) ++pictures;
  EXPECT_EQ(pictures, 3u);
  EXPECT_FALSE(has(".pictures") || has(".part") || has(".log"));
  EXPECT_NE(text_of(path("out/result.json")).find("motion.mp4"), std::string::npos);
}

TEST_F(Pictures, LeaveNoHalfFilmWhenFfmpegFailsOrIsMissing) {
  only_ffmpeg("for last; do :; done\necho half > \"$last\"\necho no such encoder >&2\nexit 1\n");
  const Outcome failed = run("--frames count=2 --motion mp4");
  EXPECT_EQ(failed.code, 2);
  EXPECT_TRUE(failed.says("no such encoder")) << failed.err;
  EXPECT_FALSE(has("motion.mp4"));
  fs::remove(path("bin/ffmpeg"));
  fs::remove_all(path("out"));
  const Outcome missing = run("--frames count=2 --motion mp4");
  EXPECT_EQ(missing.code, 2);
  EXPECT_TRUE(missing.says("apt install ffmpeg")) << missing.err;
  EXPECT_FALSE(fs::exists(path("out/result.json")));
}

}  // namespace
}  // namespace aircut
