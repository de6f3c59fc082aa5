// A log from an HDF5 file, as the text that the other readers read. libhdf5 is not made for hostile
// files: a damaged one may crash it, make it loop, or ask for any memory. So a child process with
// limits of its own reads the file and writes the text to a file without a name; whatever happens
// to it becomes a message here. What the text says is judged by the reader of texts.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "logbook/columns.h"
#include "logbook/hdf5_library.h"

namespace aircut::logbook {
namespace {

constexpr hsize_t block_rows = 65536;
constexpr unsigned read_only = 0;  // H5F_ACC_RDONLY without its call into the library
constexpr std::size_t most_attributes = 1000, longest_value = 100'000, most_joints = 64;
constexpr const char* hint = "; a joint log is what `aircut run --log` writes";

class ChildReader {
 public:
  ChildReader(const Hdf5& h, std::FILE* out) : h_(h), out_(out) {}
  /// What is wrong; empty when all is written.
  std::string run(const std::string& path);

 private:
  std::string read_keys();
  std::string read_key(hid_t attribute, std::string& key, std::string& value);
  std::string open_columns();
  std::string write_rows();

  const Hdf5& h_;
  std::FILE* out_;
  Handle file_, group_;
  std::vector<Column> columns_;
  std::vector<Handle> sets_;
  hsize_t rows_ = 0;
};

std::string ChildReader::read_key(hid_t attribute, std::string& key, std::string& value) {
  std::array<char, 256> name{};
  if (h_.H5Aget_name(attribute, name.size(), name.data()) < 0) return "a key has no name";
  key = name.data();
  const Handle type(h_.H5Aget_type(attribute), h_.H5Tclose);
  const std::size_t size = h_.H5Tget_size(type.id());
  if (h_.H5Tget_class(type.id()) != H5T_STRING || h_.H5Tis_variable_str(type.id()) != 0 ||
      size == 0 || size > longest_value)
    return "the attribute '" + printable(key) + "' is no text of fixed length";
  value.assign(size + 1, '\0');
  const Handle space(h_.H5Aget_space(attribute), h_.H5Sclose);
  if (h_.H5Sget_simple_extent_ndims(space.id()) != 0 ||
      h_.H5Aread(attribute, type.id(), value.data()) < 0)
    return "the attribute '" + printable(key) + "' can't be read";
  value.resize(std::strlen(value.c_str()));
  if (key.find_first_of("=\n") != std::string::npos || value.find('\n') != std::string::npos)
    return "the attribute '" + printable(key) + "' has a line break or a `=` in its name";
  return {};
}

std::string ChildReader::read_keys() {
  std::string joints;
  for (hsize_t i = 0; i < most_attributes; ++i) {
    const Handle attribute(h_.H5Aopen_by_idx(group_.id(), ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, i,
                                             H5P_DEFAULT, H5P_DEFAULT),
                           h_.H5Aclose);
    if (!attribute) break;
    std::string key, value;
    if (auto wrong = read_key(attribute.id(), key, value); !wrong.empty()) return wrong;
    if (key == "joints") joints = value;
    std::fprintf(out_, "# %s=%s\n", key.c_str(), value.c_str());
  }
  if (joints.empty()) return std::string("the group /joints has no attribute 'joints'") + hint;
  const std::vector<Joint> list = joints_of(joints);
  if (list.size() > most_joints) return "there are more than 64 joints";
  columns_ = columns_of(list);
  return {};
}

std::string ChildReader::open_columns() {
  for (const Column& column : columns_) {
    const std::string named = "the dataset /joints/" + column.name;
    if (h_.H5Lexists(group_.id(), column.name.c_str(), H5P_DEFAULT) <= 0)
      return named + " is missing";
    Handle set(h_.H5Dopen2(group_.id(), column.name.c_str(), H5P_DEFAULT), h_.H5Dclose);
    if (!set) return named + " can't be opened";
    const Handle space(h_.H5Dget_space(set.id()), h_.H5Sclose),
        type(h_.H5Dget_type(set.id()), h_.H5Tclose);
    const H5T_class_t kind = h_.H5Tget_class(type.id());
    hsize_t rows = 0;
    if (h_.H5Sget_simple_extent_ndims(space.id()) != 1 ||
        h_.H5Sget_simple_extent_dims(space.id(), &rows, nullptr) < 0 ||
        (kind != H5T_INTEGER && kind != H5T_FLOAT))
      return named + " is no row of numbers";
    if (sets_.empty()) {
      rows_ = rows;
      // Times differ, so they can't be packed as a few bytes: such a file promises rows that it
      // does not have.
      constexpr hsize_t densest = 4;  // rows per byte
      if (rows / densest > h_.H5Dget_storage_size(set.id()) + block_rows)
        return named + " says " + std::to_string(rows) + " rows, but has hardly any bytes";
    }
    if (rows != rows_)
      return named + " has " + std::to_string(rows) + " rows, /joints/t " + std::to_string(rows_);
    sets_.push_back(std::move(set));
  }
  return {};
}

std::string ChildReader::write_rows() {
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) text += (i > 0 ? "," : "") + columns_[i].name;
  text += '\n';
  std::vector<std::vector<double>> block(columns_.size(), std::vector<double>(block_rows));
  for (hsize_t first = 0; first < rows_; first += block_rows) {
    const hsize_t count = std::min(block_rows, rows_ - first);
    const Handle memory(h_.H5Screate_simple(1, &count, nullptr), h_.H5Sclose);
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const Handle space(h_.H5Dget_space(sets_[i].id()), h_.H5Sclose);
      if (h_.H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &first, nullptr, &count, nullptr) <
              0 ||
          h_.H5Dread(sets_[i].id(), h_.native_double, memory.id(), space.id(), H5P_DEFAULT,
                     block[i].data()) < 0)
        return "rows of the dataset /joints/" + columns_[i].name + " can't be read";
    }
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        const double value = block[i][k];
        if (i > 0) text += ',';
        constexpr double exact = 9007199254740992.0;  // 2^53
        if (columns_[i].whole && value == std::floor(value) && std::abs(value) < exact)
          text += std::to_string(static_cast<long long>(value));
        else
          append_shortest(text, value);
      }
      text += '\n';
    }
    if (std::fwrite(text.data(), 1, text.size(), out_) != text.size())
      return std::string("its text can't be written: ") + std::strerror(errno);
    text.clear();
  }
  std::fwrite(text.data(), 1, text.size(), out_);
  return std::fflush(out_) == 0 ? "" : std::string("its text can't be written: the disk is full");
}

std::string ChildReader::run(const std::string& path) {
  const Handle access(h_.H5Pcreate(h_.file_access), h_.H5Pclose);
  h_.H5Pset_file_locking(access.id(), false, true);
  file_ = Handle(h_.H5Fopen(path.c_str(), read_only, access.id()), h_.H5Fclose);
  if (!file_) return "it can't be opened as HDF5; it is damaged or cut off";
  if (h_.H5Lexists(file_.id(), "joints", H5P_DEFAULT) > 0)
    group_ = Handle(h_.H5Gopen2(file_.id(), "/joints", H5P_DEFAULT), h_.H5Gclose);
  if (!group_) return std::string("it has no group /joints") + hint;
  for (const auto step :
       {&ChildReader::read_keys, &ChildReader::open_columns, &ChildReader::write_rows})
    if (std::string wrong = (this->*step)(); !wrong.empty()) return wrong;
  return {};
}

void limit_child() {
  const rlimit seconds{600, 600}, no_core{0, 0};
  ::setrlimit(RLIMIT_CPU, &seconds);
  ::setrlimit(RLIMIT_CORE, &no_core);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // Sanitizers reserve terabytes of addresses.
  const rlimit bytes{rlim_t{2} << 30, rlim_t{2} << 30};
  ::setrlimit(RLIMIT_AS, &bytes);
#endif
}

// Reads in a child; what is wrong, or empty.
std::string read_in_child(const Hdf5& h, const std::string& path, std::FILE* out) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return std::strerror(errno);
  const pid_t child = ::fork();
  if (child == 0) {
    limit_child();
    const std::string wrong = ChildReader(h, out).run(path);
    const bool told =
        ::write(pipe[1], wrong.data(), wrong.size()) == static_cast<ssize_t>(wrong.size());
    ::_exit(wrong.empty() ? 0 : told ? 1 : 2);
  }
  ::close(pipe[1]);
  std::string said;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; child > 0 && (n = ::read(pipe[0], buffer.data(), buffer.size())) > 0;)
    said.append(buffer.data(), static_cast<std::size_t>(n));
  ::close(pipe[0]);
  if (child < 0) return std::string("no process to read it in: ") + std::strerror(errno);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFEXITED(status) && !said.empty()) return said;
  return "the HDF5 library failed on it, so it is damaged";
}

}  // namespace

Expected<const SourceText*> open_log(SourceMap& sources, const std::string& path) {
  constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);
  auto text = sources.open(path);
  if (!text || !(*text)->content().starts_with(signature)) return text;
  const auto wrong = [&](const std::string& why) {
    return unexpected(make_error("input", "'" + printable(path) + "' is no joint log: " + why));
  };
  const auto library = open_hdf5();
  if (!library) return unexpected(library.error());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::tmpfile(), &std::fclose);
  if (!out) return wrong(std::string("no temporary file: ") + std::strerror(errno));
  if (const std::string why = read_in_child(*library, path, out.get()); !why.empty())
    return wrong(why);
  std::rewind(out.get());
  return sources.read(out.get(), path);
}

}  // namespace aircut::logbook
