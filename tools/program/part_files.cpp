// SPDX-License-Identifier: BSD-3-Clause
// Stores the fields of a part and of the boundary as pieces of a hashed file.
#include "program/part_files.hpp"

#include <utility>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "partition/check_part.hpp"
#include "partition/part_fields.hpp"
#include "program/case_identity.hpp"
#include "program/check_boundary.hpp"
#include "program/hashed_file.hpp"
#include "program/output_folder.hpp"

namespace kacanov {

void exchange_fields(Either<Group> auto& group, const auto& stream) {
  stream(group.name, group.dimension, group.members);
}

/// The data that keep_boundary() leaves.
void exchange_fields(Either<Problem> auto& problem, const auto& stream) {
  auto& mesh = problem.mesh;
  stream(mesh.type, mesh.coordinates, mesh.elements, mesh.node_tags, mesh.element_tags, mesh.facets,
         mesh.facet_element, mesh.groups, problem.contact, problem.warnings);
}

namespace {

constexpr std::string_view part_magic = "kacanov part 14\n", boundary_magic = "kacanov boundary 6\n";
/// Sections of a case that the parts depend on.
constexpr const char* sections[] = {"plane",    "thickness", "mesh",  "material",
                                    "boundary", "contact",   "steps", "probe"};

std::filesystem::path part_file(const std::filesystem::path& folder, int rank) {
  return folder / ("part_" + std::to_string(rank) + ".kacanov");
}

std::filesystem::path boundary_file(const std::filesystem::path& folder) {
  return folder / "boundary.kacanov";
}

/// Length and hash of the mesh file; null if the file is missing, as on a machine that has only the parts.
nlohmann::json mesh_identity(const Case& input) {
  PlainFile file;
  if (input.mesh.file) file.open(*input.mesh.file, std::ios::binary);
  if (!file.is_open()) return nullptr;
  std::vector<char> piece(std::size_t{1} << 20);
  std::uint64_t bytes = 0, hash = 0;
  do {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const std::size_t length = file.gcount();
    hash = hash_bytes(piece.data(), length, hash);
    bytes += length;
  } while (file);
  return {{"bytes", bytes}, {"hash", hash}};
}

HashedReader open_file(const std::filesystem::path& file, std::string_view magic, const std::string& kind) {
  if (!std::filesystem::exists(file))
    throw InputError("--parts: there is no file " + file.string() + ", which kacanov partition writes");
  return HashedReader(file.string(), magic, kind);
}

HashedReader open_part(const std::filesystem::path& folder, int rank) {
  return open_file(part_file(folder, rank), part_magic, "part");
}

HashedReader open_boundary(const std::filesystem::path& folder) {
  return open_file(boundary_file(folder), boundary_magic, "boundary");
}

/// Throws InputError if the parts were made from a different case.
void check_case(const nlohmann::json& header, const Case& input, const std::string& file) {
  const nlohmann::json& there = header.at("case");
  const std::string text =
      describe_differences(there, input.document, differing_sections(there, input.document, sections));
  if (!text.empty()) throw InputError("--parts: " + file + " belongs to another case: " + text);
}

/// Throws InputError if the mesh file exists and is not the one that the parts were made from. It is hashed,
/// not parsed.
void check_mesh(const nlohmann::json& header, const Case& input, const std::string& file) {
  const nlohmann::json &there = header.at("mesh_file"), here = mesh_identity(input);
  if (here.is_null() || here == there) return;
  const auto text = [](const nlohmann::json& mesh) {
    PlainText words;
    words << mesh.at("bytes") << " bytes with hash " << std::hex << mesh.at("hash").get<std::uint64_t>();
    return words.str();
  };
  throw InputError("--parts: " + file + " was made of another mesh: " + *input.mesh.file + " had " +
                   text(there) + ", and now has " + text(here));
}

/// Throws InputError if a part refers to entries that the case does not have.
void check_entries(const Part& part, const Model& model) {
  const auto below = [](std::int32_t entry, std::size_t count) {
    return static_cast<std::size_t>(entry) < count;
  };
  bool fits = true;
  for (const Support& support : part.supports) fits = fits && below(support.entry, model.boundary.size());
  for (const AppliedLoad& load : part.applied) fits = fits && below(load.entry, model.boundary.size());
  for (const ContactPoint& point : part.contact) fits = fits && below(point.entry, model.contact.size());
  for (const PointShare& share : part.contact_shares) fits = fits && below(share.entry, model.contact.size());
  if (!fits) throw InputError("the part names an entry that the case does not have");
}

/// Throws InputError unless this is the header of this rank's part, for this case and this number of ranks.
void check_part(const nlohmann::json& header, const Case& input, const MpiSession& mpi,
                const std::string& file) {
  check_case(header, input, file);
  const int parts = header.at("parts"), part = header.at("part");
  if (parts != mpi.ranks()) {
    throw InputError("--parts: " + file + " is one of " + std::to_string(parts) +
                     " parts, expected as many ranks, but " + std::to_string(mpi.ranks()) + " were started");
  }
  if (part != mpi.rank())
    throw InputError("--parts: " + file + ": expected part " + std::to_string(mpi.rank()) + ", got part " +
                     std::to_string(part));
}

/// Returns whether the name is that of a partition file, complete or unfinished.
bool is_own_file(const std::string& name) {
  return (name.starts_with("part_") || name.starts_with("boundary.")) &&
         name.find(".kacanov") != std::string::npos;
}

/// A folder for files until all of them are complete. The destructor removes it with all files left; the
/// constructor removes the rest of a killed attempt. Throws InputError if a folder of this name contains
/// anything else.
class Staging {
 public:
  explicit Staging(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (std::filesystem::exists(std::filesystem::symlink_status(folder_))) {
      if (!std::filesystem::is_directory(std::filesystem::symlink_status(folder_))) refuse(folder_);
      for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (!entry.is_regular_file() || !is_own_file(entry.path().filename().string())) refuse(entry.path());
    }
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directory(folder_);
  }
  ~Staging() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  [[noreturn]] static void refuse(const std::filesystem::path& what) {
    throw InputError("--output: " + what.string() +
                     " stands where parts are kept until all are written, and is none of them: move it away");
  }
  std::filesystem::path folder_;
};

/// Identifier that all files of one partition share.
std::uint64_t split_identity(nlohmann::json header) {
  header.erase("part");
  const std::string text = header.dump();
  return hash_bytes(text.data(), text.size());
}

}  // namespace

void write_parts(const std::filesystem::path& folder, const Case& input, Problem problem, int parts) {
  const OutputFolder held(folder);
  const Staging staging(folder / "unfinished");
  const nlohmann::json header{{"parts", parts},
                              {"case", case_sections(input.document, sections)},
                              {"mesh_file", mesh_identity(input)},
                              {"problem", fingerprint_json(fingerprint(problem))}};
  const ElementSets sets = element_sets(problem.mesh);
  split(problem, parts, [&](int rank, Part&& part) {
    nlohmann::json own = header;
    own["part"] = rank;
    HashedWriter file(part_file(staging.folder(), rank).string(), part_magic, own);
    const FieldWriter write{file};
    write(part);
    write(sets_of_part(sets, part));
    file.commit();
  });
  const std::vector<std::int32_t> boundary_nodes = keep_boundary(problem);
  {
    HashedWriter file(boundary_file(staging.folder()).string(), boundary_magic, header);
    const FieldWriter write{file};
    write(problem);
    write(boundary_nodes);
    write(sets.names);
    file.commit();
  }
  std::filesystem::remove(boundary_file(folder));
  for (int rank = 0; rank < parts; ++rank)
    std::filesystem::rename(part_file(staging.folder(), rank), part_file(folder, rank));
  for (int rank = parts; std::filesystem::remove(part_file(folder, rank)); ++rank) {
  }
  std::filesystem::rename(boundary_file(staging.folder()), boundary_file(folder));
}

int count_parts(const std::filesystem::path& folder, const Case& input) {
  const HashedReader reader = open_boundary(folder);
  const std::string file = boundary_file(folder).string();
  return reading_header(file, [&]() -> int {
    check_case(reader.header(), input, file);
    return reader.header().at("parts");
  });
}

LoadedCase load_parts(const std::filesystem::path& folder, const Case& input, const MpiSession& mpi) {
  const double start = MPI_Wtime();
  LoadedCase loaded;
  std::uint64_t identity = 0, first_identity = 0;
  together(mpi, [&] {
    if (mpi.first()) {
      HashedReader reader = open_boundary(folder);
      const std::string file = boundary_file(folder).string();
      reading_header(file, [&] {
        check_case(reader.header(), input, file);
        check_mesh(reader.header(), input, file);
        loaded.print = parse_fingerprint(reader.header().at("problem"));
      });
      const FieldReader read{reader};
      read(loaded.problem.emplace());
      read(loaded.boundary_nodes);
      read(loaded.set_names);
      reader.finish();
      first_identity = split_identity(reader.header());
    }
    HashedReader reader = open_part(folder, mpi.rank());
    const std::string file = part_file(folder, mpi.rank()).string();
    reading_header(file, [&] { check_part(reader.header(), input, mpi, file); });
    const FieldReader read{reader};
    read(loaded.part);
    read(loaded.sets);
    reader.finish();
    try {
      check_part(loaded.part, mpi.rank(), mpi.ranks());
      if (loaded.sets.size() > 1 && loaded.sets.size() != loaded.part.element_count())
        throw InputError("sets of elements: expected " + std::to_string(loaded.part.element_count()) +
                         ", got " + std::to_string(loaded.sets.size()));
      check_entries(loaded.part, input.model);
    } catch (const InputError& error) {
      throw InputError("--parts: " + file + ": " + error.what());
    }
    identity = split_identity(reader.header());
    if (mpi.first()) try {
        check_boundary(*loaded.problem, loaded.boundary_nodes, loaded.part);
      } catch (const InputError& error) {
        throw InputError("--parts: " + boundary_file(folder).string() + ": " + error.what());
      }
    if (mpi.first()) print_warnings(input, *loaded.problem);
  });
  mpi.expect_all_here();
  MPI_Bcast(&first_identity, 1, MPI_UINT64_T, 0, mpi.comm());
  together(mpi, [&] {
    if (identity != first_identity) {
      throw InputError("--parts: " + part_file(folder, mpi.rank()).string() +
                       " belongs to another split than " + boundary_file(folder).string() +
                       "; write all of them again");
    }
  });
  join(loaded.part, mpi.comm());
  loaded.read_seconds = MPI_Wtime() - start;
  return loaded;
}

}  // namespace kacanov
