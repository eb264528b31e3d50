#include "libmpm/io/hdf5_file.hpp"

#include <hdf5.h>
#include <hdf5_hl.h>

#include <array>
#include <cerrno>
#include <type_traits>
#include <utility>

#include "libmpm/io/write_error.hpp"

namespace tremie::io {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>);

/// The error of the first handle that could not be closed; 0: none. What is packed is written as it is closed.
thread_local int lost_in_closing = 0;

/// An HDF5 handle with the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0 && close_(id_) < 0 && lost_in_closing == 0) lost_in_closing = errno != 0 ? errno : EIO;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// How objects are made that carry no times.
Handle without_times(hid_t kind) {
  const hid_t creation = H5Pcreate(kind);
  H5Pset_obj_track_times(creation, false);
  return {creation, H5Pclose};
}

herr_t write_attribute(hid_t object, const std::string& name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute < 0 ? -1 : H5Awrite(attribute, type, value);
}

}  // namespace

Hdf5File::Hdf5File(const std::filesystem::path& file) : path_(file) {
  // After a write that failed (a full disk) the library's own clean-up at exit would try again, and crash.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
  errno = 0;
  lost_in_closing = 0;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V110);
  file_ = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  check(file_);
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::check(std::int64_t status) {
  if (status < 0) fail_to_write(path_);
}

void Hdf5File::close() {
  errno = 0;
  check(H5Fclose(std::exchange(file_, -1)));
  if (lost_in_closing == 0) return;
  errno = std::exchange(lost_in_closing, 0);
  check(-1);
}

void Hdf5File::group(const std::string& path) {
  errno = 0;
  const Handle creation = without_times(H5P_GROUP_CREATE);
  const Handle made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
  check(made);
}

std::int64_t Hdf5File::open(const std::string& object) {
  errno = 0;
  const hid_t id = H5Oopen(file_, object.c_str(), H5P_DEFAULT);
  check(id);
  return id;
}

void Hdf5File::attribute(const std::string& object, const std::string& name, double value) {
  const Handle id(open(object), H5Oclose);
  check(write_attribute(id, name, H5T_NATIVE_DOUBLE, &value));
}

void Hdf5File::attribute(const std::string& object, const std::string& name, std::int64_t value) {
  const Handle id(open(object), H5Oclose);
  check(write_attribute(id, name, H5T_NATIVE_INT64, &value));
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Handle id(open(object), H5Oclose);
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);  // Python reads it as a string, one of fixed length as bytes
  H5Tset_cset(type, H5T_CSET_UTF8);
  const char* text = value.c_str();
  check(write_attribute(id, name, type, &text));
}

void Hdf5File::array(const std::string& path, std::span<const double> values, std::size_t columns,
                     const std::string& unit, const std::string& description, bool packed) {
  errno = 0;
  const std::array<hsize_t, 2> size{values.size() / columns, columns};
  const Handle space(H5Screate_simple(columns == 1 ? 1 : 2, size.data(), nullptr), H5Sclose);
  const Handle creation = without_times(H5P_DATASET_CREATE);
  if (packed && !values.empty()) {
    H5Pset_chunk(creation, columns == 1 ? 1 : 2, size.data());
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 1);
  }
  {
    const Handle made(H5Dcreate2(file_, path.c_str(), packed ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE, space,
                                 H5P_DEFAULT, creation, H5P_DEFAULT),
                      H5Dclose);
    check(made);
    check(H5Dwrite(made, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  }
  attribute(path, "unit", unit);
  if (!description.empty()) attribute(path, "description", description);
}

void Hdf5File::scale(const std::string& path, const std::vector<std::string>& along, unsigned axis) {
  const Handle made(open(path), H5Oclose);
  if (H5DSis_scale(made) <= 0) check(H5DSset_scale(made, path.substr(path.rfind('/') + 1).c_str()));
  for (const std::string& array : along) {
    const Handle data(open(array), H5Oclose);
    check(H5DSattach_scale(data, made, axis));
  }
}

void Hdf5File::dimension(const std::string& path, std::size_t size, const std::vector<std::string>& along,
                         unsigned axis) {
  errno = 0;
  const hsize_t places = size;
  const Handle space(H5Screate_simple(1, &places, nullptr), H5Sclose);
  const Handle creation = without_times(H5P_DATASET_CREATE);
  {
    const Handle made(
        H5Dcreate2(file_, path.c_str(), H5T_IEEE_F32BE, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
    check(made);
    // netCDF's own words for an axis that is no variable.
    check(H5DSset_scale(made, "This is a netCDF dimension but not a netCDF variable."));
  }
  scale(path, along, axis);
}

}  // namespace tremie::io
