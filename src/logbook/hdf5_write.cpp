// A log's rows as HDF5: in the group /joints a dataset per column (chunks of 65536 rows, shuffled,
// deflated) with the attributes `unit` and `frame`; the header's keys are attributes of the group.
// Times of creation are left out, so that equal logs are equal bytes. A block of rows is held at a
// time.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "logbook/columns.h"
#include "logbook/hdf5_library.h"

namespace aircut::logbook {
namespace {

constexpr hsize_t block_rows = 65536;
constexpr unsigned effort = 4;    // of deflate
constexpr unsigned truncate = 2;  // H5F_ACC_TRUNC without its call into the library

class Writer {
 public:
  Writer(const Hdf5& h, std::string path) : h_(h), path_(std::move(path)) {}
  ~Writer() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  Expected<void> run(const SourceText& log);

 private:
  bool create(const Header& header);
  bool attribute(hid_t of, const std::string& name, const std::string& value);
  bool write_block();
  Expected<void> rename();
  Diagnostic failed(const std::string& why) const {
    return make_error("output_failed", "can't write '" + printable(path_) + "': " + why);
  }

  const Hdf5& h_;
  std::string path_, temporary_;
  Handle file_, group_;
  std::vector<Handle> sets_;
  std::vector<std::vector<double>> block_;  ///< by column
  hsize_t written_ = 0;
};

bool Writer::attribute(hid_t of, const std::string& name, const std::string& value) {
  const Handle type(h_.H5Tcopy(h_.c_string), h_.H5Tclose);
  const Handle space(h_.H5Screate(H5S_SCALAR), h_.H5Sclose);
  if (h_.H5Tset_size(type.id(), value.size() + 1) < 0) return false;
  h_.H5Tset_cset(type.id(), H5T_CSET_UTF8);
  const Handle made(
      h_.H5Acreate2(of, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
      h_.H5Aclose);
  return made && h_.H5Awrite(made.id(), type.id(), value.c_str()) >= 0;
}

bool Writer::create(const Header& header) {
  const Handle access(h_.H5Pcreate(h_.file_access), h_.H5Pclose);
  h_.H5Pset_file_locking(access.id(), false, true);
  file_ = Handle(h_.H5Fcreate(temporary_.c_str(), truncate, H5P_DEFAULT, access.id()), h_.H5Fclose);
  const Handle ordered(h_.H5Pcreate(h_.group_create), h_.H5Pclose);
  h_.H5Pset_attr_creation_order(ordered.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  h_.H5Pset_obj_track_times(ordered.id(), false);
  group_ = Handle(h_.H5Gcreate2(file_.id(), "/joints", H5P_DEFAULT, ordered.id(), H5P_DEFAULT),
                  h_.H5Gclose);
  if (!group_) return false;
  for (const std::string& key : header.order)
    if (!attribute(group_.id(), key, header.keys.at(key))) return false;
  const Handle list(h_.H5Pcreate(h_.dataset_create), h_.H5Pclose);
  h_.H5Pset_chunk(list.id(), 1, &block_rows);
  h_.H5Pset_shuffle(list.id());
  h_.H5Pset_deflate(list.id(), effort);
  h_.H5Pset_obj_track_times(list.id(), false);
  const hsize_t none = 0, any = H5S_UNLIMITED;
  const Handle space(h_.H5Screate_simple(1, &none, &any), h_.H5Sclose);
  for (const Column& column : columns_of(header.joints)) {
    const hid_t type = column.whole ? h_.file_int64 : h_.file_double;
    Handle set(h_.H5Dcreate2(group_.id(), column.name.c_str(), type, space.id(), H5P_DEFAULT,
                             list.id(), H5P_DEFAULT),
               h_.H5Dclose);
    if (!set || !attribute(set.id(), "unit", column.unit) ||
        !attribute(set.id(), "frame", column.frame))
      return false;
    sets_.push_back(std::move(set));
  }
  block_.resize(sets_.size());
  return true;
}

bool Writer::write_block() {
  const hsize_t count = block_.front().size(), whole = written_ + count;
  if (count == 0) return true;
  const Handle memory(h_.H5Screate_simple(1, &count, nullptr), h_.H5Sclose);
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    if (h_.H5Dset_extent(sets_[i].id(), &whole) < 0) return false;
    const Handle space(h_.H5Dget_space(sets_[i].id()), h_.H5Sclose);
    if (h_.H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &written_, nullptr, &count, nullptr) < 0)
      return false;
    if (h_.H5Dwrite(sets_[i].id(), h_.native_double, memory.id(), space.id(), H5P_DEFAULT,
                    block_[i].data()) < 0)
      return false;
    block_[i].clear();
  }
  written_ = whole;
  return true;
}

// Everything is on the disk before the file gets its name.
Expected<void> Writer::rename() {
  const int fd = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = fd >= 0 && ::fsync(fd) == 0;
  if (fd >= 0) ::close(fd);
  if (!synced || std::rename(temporary_.c_str(), path_.c_str()) != 0)
    return unexpected(failed(std::strerror(errno)));
  temporary_.clear();
  return {};
}

Expected<void> Writer::run(const SourceText& log) {
  auto reader = Reader::open(log);
  if (!reader) return unexpected(reader.error());
  temporary_ = path_ + ".partial-XXXXXX";
  const int fd = ::mkstemp(temporary_.data());
  if (fd < 0) {
    temporary_.clear();
    return unexpected(failed(std::strerror(errno)));
  }
  ::fchmod(fd, 0644);
  ::close(fd);
  const char* refused = "the HDF5 library refused it; is the disk full?";
  if (!create(reader->header())) return unexpected(failed(refused));
  Row row;
  for (;;) {
    const auto more = reader->next(row);
    if (!more) return unexpected(more.error());
    if (!*more) break;
    for (std::size_t i = 0; i < block_.size(); ++i) block_[i].push_back(row.values[i]);
    if (block_.front().size() == block_rows && !write_block()) return unexpected(failed(refused));
  }
  if (!write_block()) return unexpected(failed(refused));
  sets_.clear();
  group_ = {};
  // Closing writes what is left.
  if (file_.close() < 0) return unexpected(failed(refused));
  return rename();
}

}  // namespace

Expected<void> hdf5_ready() {
  const auto library = open_hdf5();
  if (!library) return unexpected(library.error());
  return {};
}

Expected<void> write_hdf5(const SourceText& log, const std::string& path) {
  const auto library = open_hdf5();
  if (!library) return unexpected(library.error());
  return Writer(*library, path).run(log);
}

}  // namespace aircut::logbook
