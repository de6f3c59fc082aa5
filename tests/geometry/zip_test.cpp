#include "geometry/zip.h"

#include <gtest/gtest.h>

namespace aircut::geometry {
namespace {

std::string unpacked(const std::string& packed, std::size_t most = 1000) {
  const ZipEntry entry{.name = "x", .packed = packed.size(), .method = 8};
  return unpack_start(packed, entry, most).value_or("(broken)");
}

std::string bytes_of(std::initializer_list<int> list) {
  std::string out;
  for (const int b : list) out.push_back(static_cast<char>(b));
  return out;
}

// Made with Python's zlib.compress(…)[2:-4].
const std::string fixed_stream = bytes_of({75, 76, 74, 78, 68, 66, 0});
const std::string described_stream = bytes_of(
    {237, 212, 221, 13,  2,   33,  16,  4,   224, 86,  44,  225, 128, 59,  224, 18,  45,  199, 6,
     140, 49,  87,  190, 143, 124, 38,  80,  129, 251, 182, 217, 12,  195, 236, 223, 108, 247, 207,
     243, 245, 126, 94,  183, 235, 145, 70,  184, 143, 240, 4,   80,  71,  156, 143, 17,  23,  242,
     59,  248, 10,  77,  135, 189, 64,  3,   100, 111, 35,  110, 25,  12,  47,  97,  169, 228, 79,
     213, 64,  223, 54,  212, 131, 63,  192, 156, 170, 183, 112, 251, 33,  30,  204, 1,   127, 71,
     26,  114, 50,  85,  117, 48,  7,   52,  25,  105, 221, 6,   218, 52,  56,  19,  249, 142, 252,
     106, 41,  252, 85,  224, 79,  234, 164, 42,  42,  236, 124, 213, 144, 211, 204, 151, 69,  188,
     120, 43,  167, 127, 213, 185, 50,  21,  91,  137, 21,  90,  121, 90,  116, 202, 14,  218, 89,
     59,  238, 36,  156, 144, 147, 115, 162, 125, 62,  127, 247, 226, 103, 95,  210, 98,  191, 234,
     124, 31,  221, 83,  247, 215, 189, 118, 223, 235, 226, 62,  242, 252, 154, 188, 50,  175, 175,
     204, 111, 213, 27,  246, 182, 203, 194, 11,  244, 136, 115, 106, 40,  144, 111, 97,  62,  97,
     62,  97,  62,  97,  62,  97,  62,  97,  62,  97,  62,  97,  62,  97,  62,  97,  62,  97,  62,
     97,  62,  97,  62,  127, 98,  62,  95});

TEST(Inflate, ReadsAStoredBlock) {
  EXPECT_EQ(unpacked(bytes_of({1, 3, 0, 0xfc, 0xff, 'a', 'b', 'c'})), "abc");
}

TEST(Inflate, ReadsFixedCodesWithARepeat) { EXPECT_EQ(unpacked(fixed_stream), "abcabcabcabcabc"); }

TEST(Inflate, ReadsDescribedCodes) {
  std::string wanted;
  for (int i = 0; i < 400; ++i) wanted += std::to_string(i * i % 97) + "<vertex x=";
  EXPECT_EQ(unpacked(described_stream, 100000), wanted);
  EXPECT_EQ(unpacked(described_stream, 50), wanted.substr(0, 50));
}

TEST(Inflate, RefusesBrokenStreams) {
  EXPECT_EQ(unpacked(""), "(broken)");
  EXPECT_EQ(unpacked(bytes_of({7})), "(broken)");
  EXPECT_EQ(unpacked(bytes_of({1, 3, 0, 0, 0, 'a'})), "(broken)");
  EXPECT_EQ(unpacked(described_stream.substr(0, described_stream.size() / 2), 100000), "(broken)");
}

TEST(Zip, RefusesWhatIsNoArchive) {
  EXPECT_FALSE(zip_entries("no archive"));
  EXPECT_FALSE(zip_entries(std::string("PK\5\6") + std::string(18, '\xff')));
}

}  // namespace
}  // namespace aircut::geometry
