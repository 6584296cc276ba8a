// SPDX-License-Identifier: BSD-3-Clause
// Reads obstacles from files of their own.
#include "program/obstacle_files.hpp"

#include <kacanov/error.hpp>
#include <kacanov/obstacle.hpp>
#include <kacanov/surface.hpp>
#include "formats/height_reader.hpp"
#include "formats/surface_reader.hpp"

namespace kacanov {
namespace {

HeightField read_field(const ObstacleFile& file, const SourceFile& source) {
  const NumberGrid grid = read_heights(source);
  HeightField field{grid.rows, grid.columns, grid.values, file.lower, file.upper};
  for (double& height : field.height) height = file.offset + file.scale * height;
  return field;
}

}  // namespace

Model model_with_files(const Case& input) {
  Model model = input.model;
  for (const ObstacleFile& file : input.obstacle_files) {
    Obstacle& obstacle = model.contact.at(file.contact).obstacle;
    const SourceFile source = source_file(file.name, input.mesh.folder);
    try {
      if (auto* surface = std::get_if<SurfaceObstacle>(&obstacle))
        surface->surface = std::make_shared<const Surface>(read_surface(source, file.group));
      else
        std::get<HeightMap>(obstacle).field = std::make_shared<const HeightField>(read_field(file, source));
    } catch (const InputError& error) {
      throw InputError(file.path + ".file: " + error.what());
    }
  }
  return model;
}

}  // namespace kacanov
