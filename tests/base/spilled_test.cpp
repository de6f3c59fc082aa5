// Arrays of which most lies in a temporary file, against std::vector.
#include "base/spilled.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <random>

namespace aircut::test {
namespace {

struct Row {
  std::uint64_t key = 0;
  std::uint64_t place = 0;

  bool operator==(const Row&) const = default;
};

bool by_key(const Row& a, const Row& b) {
  return a.key != b.key ? a.key < b.key : a.place < b.place;
}

std::vector<Row> rows_by_chance(std::size_t count) {
  std::mt19937_64 random(7);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < count; ++i) rows.push_back({random() % (count / 2 + 1), i});
  return rows;
}

constexpr std::size_t past_the_memory = SpilledMemory::most_in_memory / sizeof(Row) * 5 + 11;

TEST(Spilled, KeepsAndSortsLikeAVector) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{5000}, past_the_memory}) {
    std::vector<Row> rows = rows_by_chance(count);
    SpilledArray<Row> array;
    for (const Row& row : rows) ASSERT_TRUE(array.push_back(row));
    ASSERT_EQ(array.size(), count);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(array[i], rows[i]) << i;
    ASSERT_TRUE(array.sort(by_key));
    std::sort(rows.begin(), rows.end(), by_key);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(array[i], rows[i]) << i;
    for (const std::uint64_t key :
         {std::uint64_t{0}, std::uint64_t{count / 3}, ~std::uint64_t{0}}) {
      const auto below = [](const Row& row, std::uint64_t k) { return row.key < k; };
      EXPECT_EQ(array.lower_bound(key, below),
                static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), key, below) -
                                         rows.begin()));
    }
  }
}

TEST(Spilled, CanBeChangedInPlaceAndMoved) {
  SpilledArray<Row> array;
  for (std::size_t i = 0; i < past_the_memory; ++i) ASSERT_TRUE(array.push_back({i, 0}));
  for (std::size_t i = 0; i < array.size(); i += 1000) array[i].place = i + 1;
  SpilledArray<Row> other = std::move(array);
  for (std::size_t i = 0; i < other.size(); ++i)
    ASSERT_EQ(other[i], (Row{i, i % 1000 == 0 ? i + 1 : 0}));
}

TEST(Spilled, SaysWhenThereIsNoRoom) {
  rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1 << 20;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  SpilledArray<Row> array;
  std::size_t held = 0;
  while (held < past_the_memory && array.push_back({held, 0})) ++held;
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(held, SpilledMemory::most_in_memory / sizeof(Row));
  for (std::size_t i = 0; i < held; ++i) ASSERT_EQ(array[i].key, i);  // what it had, it has
}

}  // namespace
}  // namespace aircut::test
