// SPDX-License-Identifier: BSD-3-Clause
// Writes the XML header and appends the compressed arrays.
#include "formats/vtu_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include <kacanov/error.hpp>
#include "formats/xml.hpp"
#include "mesh/classic_locale_stream.hpp"

namespace kacanov {
namespace {

constexpr const char* byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

std::string header(const char* type, const char* more = "") {
  return std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"") + type +
         "\" version=\"1.0\" byte_order=\"" + byte_order + "\" header_type=\"UInt64\"" + more + ">\n";
}

/// Number of components in the file: in 2D two become three.
std::size_t written_components(const Grid& grid, const Field& field) {
  return grid.dim == 2 && field.components == 2 ? 3 : static_cast<std::size_t>(field.components);
}

struct FieldType {
  const char* name;
  std::size_t bytes;
};

FieldType field_type(const Field& field) {
  constexpr std::array<FieldType, 3> types{{{"Float64", 8}, {"Int64", 8}, {"UInt8", 1}}};
  return types[field.values.index()];
}

std::string array_attributes(const Grid& grid, const Field& field) {
  std::string text = std::string("type=\"") + field_type(field).name + "\" Name=\"" + xml_escape(field.name) +
                     "\" NumberOfComponents=\"" + std::to_string(written_components(grid, field)) + "\"";
  if (field.components == 6) {
    constexpr std::array<const char*, 6> names{"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
    for (std::size_t k = 0; k < names.size(); ++k)
      text += " ComponentName" + std::to_string(k) + "=\"" + names[k] + "\"";
  }
  return text;
}

/// Converts values and passes them on a few thousand at a time.
template <typename T>
class Buffer {
 public:
  explicit Buffer(const std::function<void(const void*, std::size_t)>& take) : take_(take) {
    values_.reserve(capacity);
  }
  void push(T value) {
    values_.push_back(value);
    if (values_.size() == capacity) flush();
  }
  void flush() {
    take_(values_.data(), values_.size() * sizeof(T));
    values_.clear();
  }

 private:
  static constexpr std::size_t capacity = 1 << 13;
  const std::function<void(const void*, std::size_t)>& take_;
  std::vector<T> values_;
};

constexpr std::size_t entries_at_a_time = 4096;

/// Writes entries of `from` components as entries of `to` components, padded with zeros.
template <typename T, typename Take>
void visit_padded(const Values<T>& values, std::size_t from, std::size_t to, const Take& take) {
  Buffer<T> buffer(take);
  values.visit(entries_at_a_time * from, [&](std::span<const T> some) {
    if (from == to) {
      take(some.data(), some.size_bytes());
      return;
    }
    for (std::size_t i = 0; i < some.size(); i += from)
      for (std::size_t k = 0; k < to; ++k) buffer.push(k < from ? some[i + k] : T{0});
  });
  buffer.flush();
}

constexpr const char* point_data = "PointData";
constexpr const char* cell_data = "CellData";
constexpr std::array<const char*, 4> sections{point_data, cell_data, "Points", "Cells"};

/// Longest offset, as a placeholder in the header.
constexpr std::uint64_t longest_offset = std::numeric_limits<std::uint64_t>::max();

}  // namespace

VtuShare::VtuShare(const std::string& path, const Grid& grid, const GridPlace& place) : place_(place) {
  const std::size_t dim = grid.dim, points = grid.points.size() / dim,
                    cells = grid.cells.size() / static_cast<std::size_t>(grid.cell->nodes);
  const auto add = [&](const char* section, const std::vector<Field>& fields, std::size_t count) {
    for (const Field& field : fields) {
      const std::size_t size = std::visit([](const auto& values) { return values.size(); }, field.values);
      if (size != count * static_cast<std::size_t>(field.components))
        throw InternalError(path + ": the field " + field.name + " has " + std::to_string(size) +
                            " values for " + std::to_string(count) + " times " +
                            std::to_string(field.components));
      add_field(section, grid, field);
    }
  };
  add(point_data, grid.point_fields, points);
  add(cell_data, grid.cell_fields, cells);
  arrays_.push_back({"Points", "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"",
                     place.points * 3 * 8, place.points_before * 3 * 8,
                     [values = Values<double>(grid.points.first(points * dim)), dim](const TakeBytes& take) {
                       visit_padded(values, dim, 3, take);
                     }});
  add_cells(grid);
}

void VtuShare::add_field(const char* section, const Grid& grid, const Field& field) {
  const std::size_t to = written_components(grid, field), bytes = to * field_type(field).bytes,
                    from = field.components;
  const bool of_points = section == point_data;
  arrays_.push_back({section, array_attributes(grid, field),
                     (of_points ? place_.points : place_.cells) * bytes,
                     (of_points ? place_.points_before : place_.cells_before) * bytes,
                     [&values = field.values, from, to](const TakeBytes& take) {
                       std::visit([&](const auto& some) { visit_padded(some, from, to, take); }, values);
                     }});
}

void VtuShare::add_cells(const Grid& grid) {
  const std::size_t nodes = grid.cell->nodes, cells = grid.cells.size() / nodes;
  const auto connectivity = [&grid, nodes, cells](const TakeBytes& take) {
    Buffer<std::int32_t> buffer(take);
    for (std::size_t c = 0; c < cells; ++c)
      for (const std::int8_t from : grid.cell->vtk_order) {
        const std::int32_t node = grid.cells[c * nodes + static_cast<std::size_t>(from)];
        buffer.push(grid.number_of_point ? static_cast<std::int32_t>(grid.number_of_point(node)) : node);
      }
    buffer.flush();
  };
  const auto offsets = [nodes, cells, before = place_.cells_before](const TakeBytes& take) {
    Buffer<std::int64_t> buffer(take);
    for (std::size_t c = 0; c < cells; ++c) buffer.push(static_cast<std::int64_t>((before + c + 1) * nodes));
    buffer.flush();
  };
  const auto types = [cells, type = static_cast<std::uint8_t>(grid.cell->vtk)](const TakeBytes& take) {
    Buffer<std::uint8_t> buffer(take);
    for (std::size_t c = 0; c < cells; ++c) buffer.push(type);
    buffer.flush();
  };
  const auto add = [&](const char* attributes, std::size_t bytes, const auto& visit) {
    arrays_.push_back({"Cells", attributes, place_.cells * bytes, place_.cells_before * bytes, visit});
  };
  add("type=\"Int32\" Name=\"connectivity\"", nodes * 4, connectivity);
  add("type=\"Int64\" Name=\"offsets\"", 8, offsets);
  add("type=\"UInt8\" Name=\"types\"", 1, types);
}

void VtuShare::pack(std::size_t array, BlockSink& sink) const {
  BlockPacker packer(arrays_[array].before, sink);
  arrays_[array].visit([&](const void* data, std::size_t bytes) { packer.write(data, bytes); });
  packer.finish();
}

VtuFileWriter::VtuFileWriter(const std::string& path, const VtuShare& share)
    : share_(share), file_(path), offsets_(share.arrays(), longest_offset) {
  const std::string longest = head();
  room_ = longest.size();
  file_.write(longest);
}

std::string VtuFileWriter::head() const {
  std::string text = header("UnstructuredGrid", " compressor=\"vtkZLibDataCompressor\"") +
                     "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" + std::to_string(share_.place_.points) +
                     "\" NumberOfCells=\"" + std::to_string(share_.place_.cells) + "\">\n";
  for (const std::string section : sections) {
    text += "<" + section + ">\n";
    for (std::size_t a = 0; a < offsets_.size(); ++a)
      if (section == share_.arrays_[a].section)
        text += "<DataArray " + share_.arrays_[a].attributes + " format=\"appended\" offset=\"" +
                std::to_string(offsets_[a]) + "\"/>\n";
    text += "</" + section + ">\n";
  }
  text += "</Piece>\n</UnstructuredGrid>\n";
  const std::string last = "<AppendedData encoding=\"raw\">\n_";
  // Readers accept blanks between elements, so pad the reserved room.
  if (room_ > text.size() + last.size()) text.append(room_ - text.size() - last.size(), ' ');
  return text + last;
}

void VtuFileWriter::put(std::span<const unsigned char> bytes) {
  file_.write(bytes.data(), bytes.size());
  written_ += bytes.size();
}

void VtuFileWriter::begin(std::size_t array) {
  array_ = array;
  offsets_[array] = written_;
  block_.clear();
  lengths_.clear();
  const std::uint64_t blocks = (share_.arrays_[array].bytes + block_bytes - 1) / block_bytes;
  put(std::vector<unsigned char>((3 + blocks) * sizeof(std::uint64_t)));
}

void VtuFileWriter::loose(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    const std::size_t some = std::min(bytes.size(), block_bytes - block_.size());
    block_.insert(block_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(some));
    bytes = bytes.subspan(some);
    if (block_.size() < block_bytes) continue;
    std::vector<unsigned char> out;
    lengths_.push_back(deflater_.pack(block_, out));
    put(out);
    block_.clear();
  }
}

void VtuFileWriter::packed(std::span<const unsigned char> bytes, std::span<const std::uint64_t> lengths) {
  put(bytes);
  lengths_.insert(lengths_.end(), lengths.begin(), lengths.end());
}

void VtuFileWriter::end() {
  const std::uint64_t last = block_.size();
  if (last > 0) {
    std::vector<unsigned char> out;
    lengths_.push_back(deflater_.pack(block_, out));
    put(out);
    block_.clear();
  }
  std::vector<std::uint64_t> front{lengths_.size(), block_bytes, last};
  front.insert(front.end(), lengths_.begin(), lengths_.end());
  file_.write_over(room_ + offsets_[array_], front.data(), front.size() * sizeof(std::uint64_t));
}

void VtuFileWriter::commit() {
  const std::string whole = head();
  file_.write_over(0, whole.data(), whole.size());
  file_.write("\n</AppendedData>\n</VTKFile>\n");
  file_.commit();
}

void write_vtu(const std::string& path, const Grid& grid) {
  const std::size_t points = grid.points.size() / static_cast<std::size_t>(grid.dim),
                    cells = grid.cells.size() / static_cast<std::size_t>(grid.cell->nodes);
  const VtuShare share(path, grid, {points, cells, 0, 0});
  VtuFileWriter file(path, share);
  for (std::size_t array = share.arrays(); array-- > 0;) {
    file.begin(array);
    share.pack(array, file);
    file.end();
  }
  file.commit();
}

void write_pvd(const std::string& path, std::span<const PvdPart> parts) {
  std::string text = header("Collection") + "<Collection>\n";
  for (const PvdPart& part : parts) {
    PlainText time;
    time.precision(17);
    time << part.time;
    text += "<DataSet timestep=\"" + time.str() + "\" part=\"" + std::to_string(part.part) + "\" name=\"" +
            xml_escape(part.name) + "\" file=\"" + xml_escape(part.file) + "\"/>\n";
  }
  write_file(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace kacanov
