// SPDX-License-Identifier: BSD-3-Clause
// Schema of every case key except those of materials and obstacles.
#include "case/case_schema.hpp"

#include <kacanov/cells.hpp>
#include "case/case_file.hpp"
#include "case/case_words.hpp"
#include "case/preset.hpp"

namespace kacanov {
namespace {

constexpr int most_refinements = 10;
constexpr int most_load_steps = 10000;

Schema vector_not_negative() { return ListOf{Number{not_negative}, "a list of 2 or 3 numbers", 2, 3}; }

/// Schema of `on`, which selects part of the mesh.
Schema selector() {
  const Schema corners = ListOf{vector_schema(),
                                "two corners",
                                2,
                                2,
                                "two corners, the lower and the upper one",
                                "two corners, the lower and the upper one"};
  const KeySet box{
      {must("box", corners, "the lower and the upper corner; what lies wholly within is selected")}};
  return Schema(Either{{Text{}, box}, "a name, \"all\" or {\"box\": [lower corner, upper corner]}"})
      .named("selector");
}

KeySet mesh() {
  Word elements;
  for (const ElementType type : element_types()) elements.words.emplace_back(cell(type).name);
  const KeySet box{
      {must("size", ListOf{Number{positive}, "a list of 2 or 3 lengths", 2, 3},
            "lengths of the box along x, y, z"),
       must("cells", ListOf{Whole{1}, "a list of 2 or 3 whole numbers", 2, 3}, "cells along each"),
       may("element", elements, "the element; left out, tri3 or tet4 by the number of entries")}};
  const Adaptivity adapting;
  const KeySet adapt{
      {must("error", Number{below_one}, "estimated error in the energy norm to be met: 0.05 for 5 %"),
       may("most_unknowns", Whole{1}, "no finer mesh than of so many is made", adapting.most_unknowns),
       may("most_meshes", Whole{1}, "nor more meshes than these", adapting.most_meshes)}};
  return {
      {may("file", Text{}, "Gmsh .msh, Abaqus or CalculiX .inp, or .vtu; relative to the case file's folder"),
       may("files", ListOf{Text{}, "a list of mesh files", 1, ListOf::any_number, "at least one mesh file"},
           "meshes of the same body, coarsest first: each is solved from the one before, the last is that of "
           "the case"),
       may("box", box,
           "a generated box from the origin to `size`, with sides left, right, front, back, bottom, top"),
       may("refine",
           Whole{0, most_refinements,
                 "at most " + std::to_string(most_refinements) + ": each makes eight elements of one"},
           "how often every edge is halved", MeshSource().refine),
       may("order", Whole{1, 2, "1 or 2"},
           "2 puts a node in the middle of every straight edge: tet10 of tet4", MeshSource().order),
       may("adapt", adapt, "refines the mesh where the solution asks for it")},
      {{{"file", "files", "box"}}}};
}

KeySet material() {
  KeySet set = material_law_keys();
  set.keys.insert(set.keys.begin(), must("on", selector(), "elements"));
  set.keys.push_back(may("formulation", Word{{"displacement", "mixed"}},
                         "mixed: a pressure of its own against locking; in tet10 linear, in tet4 by patches "
                         "of nodes, elsewhere bbar"));
  set.keys.push_back(may("expansion", Number{}, "linear thermal expansion, a strain over a temperature",
                         MaterialEntry().expansion));
  return set;
}

KeySet temperature() {
  return {{may("gradient", vector_schema(), "of a linear field: temperature over length"),
           may("value", Number{}, "of a linear field at `point`", Temperature().value),
           may("point", vector_schema(), "left out, the origin"),
           may("file", Text{}, "CSV of nodes or groups and their temperatures"),
           may("otherwise", Number{}, "of nodes that are not in the file; left out, all have to be")},
          {{{"gradient", "file"}}},
          {{"value", "gradient"}, {"point", "gradient"}, {"otherwise", "file"}}};
}

KeySet boundary() {
  const char* free_or_number = "a number, or null for a free component";
  const Schema held = ListOf{Either{{Number{}, Null{}}, free_or_number}, "a list of 2 or 3 numbers", 2, 3};
  return {
      {must("on", selector(),
            "facets; elements for body_force, density, temperature; or nodes, where nodes will do"),
       may("name", Text{}, "what results and load curves call the entry"),
       may("displacement", held, "prescribed components, lengths; null: free"),
       may("traction", vector_schema(), "a force over an area"),
       may("pressure", Number{}, "a stress against the outer normal"),
       may("body_force", vector_schema(), "a force over a volume"),
       may("total_force", vector_schema(), "a force, spread evenly over the facets"),
       may("density", Number{positive}, "a mass over a volume, for gravity"),
       may("acceleration", vector_schema(), "of gravity, beside density"),
       may("spring",
           Either{{Number{positive}, vector_not_negative()}, "a number > 0 or a list of 2 or 3 numbers"},
           "stiffness of an elastic bed, stress over length: along the normal, or by component"),
       may("node_spring", vector_not_negative(), "stiffness of each node, force over length, by component"),
       may("node_force", vector_schema(), "a force on each node"),
       may("temperature",
           Either{{Number{}, temperature()}, "a number, or an object with the key gradient or file"},
           "by how much elements are warmer than where they are free of strain"),
       may("normal", Number{},
           "displacement of flat facets along their outer normal; 0 is a plane of symmetry"),
       may("frame", axes_schema(), "orthogonal axes that the entries of displacement are along")},
      {{{"displacement", "traction", "pressure", "body_force", "total_force", "density", "spring",
         "node_spring", "node_force", "temperature", "normal"}}},
      {{"acceleration", "density", true}, {"frame", "displacement"}}};
}

KeySet motion() {
  const KeySet pose{
      {must("time", Number{positive}, "when the obstacle is there"),
       may("translation", vector_schema(), "how far it has gone, a length"),
       may("rotation", Either{{Number{}, vector_schema()}, "a number or a list of 2 or 3 numbers"},
           "how far it has turned about the centre: axis times angle in radians; in 2D a number")}};
  return {{must("path",
                ListOf{pose, "a list of places and their times", 1, ListOf::any_number, "at least one place"},
                "where the obstacle is taken to, on straight lines"),
           may("centre", vector_schema(), "what it turns about; left out, the origin")}};
}

KeySet contact() {
  const Friction friction;
  const KeySet bound{
      {may("tresca", Number{not_negative}, "the largest tangential stress"),
       may("coulomb", Number{not_negative}, "the largest tangential stress over the pressure"),
       may("reference", one_of(words::reference),
           "what slip is counted from: the undeformed body, or the end of the load step before",
           word_of(friction.reference, words::reference))},
      {{{"tresca", "coulomb"}}}};
  const KeySet force{
      {must("force", Number{positive}, "that the obstacle does to the body along the direction"),
       must("direction", vector_schema(), "towards the body, of any length")}};
  return {{must("on", selector(), "facets"),
           may("name", Text{}, "what results and load curves call the entry"),
           must("obstacle", obstacle_schema(), "what the facets may touch"),
           may("friction", bound, "left out: none"),
           may("motion", motion(), "how the obstacle moves along the load steps"),
           may("relinearise", Flag{}, "whether nodes face the obstacle anew at each load step",
               ContactEntry().relinearise),
           may("force_controlled", force, "the obstacle is pushed until it does this force to the body")}};
}

Schema steps() {
  const KeySet step{{must("time", Number{time_after_start}, "later than that of the step before"),
                     must("factors", MapOf{Number{}, "an object of entries and their factors"},
                          "by name or place of entries, what they are multiplied by from then on")}};
  return ListOf{step,
                "a list of load steps",
                1,
                most_load_steps,
                "at least one load step",
                "at most " + std::to_string(most_load_steps) + " load steps"};
}

Schema load_steps() {
  const std::string too_many = "at most " + std::to_string(most_load_steps) + " load steps";
  const Schema factors = ListOf{Number{load_factor}, "a list of factors", 1, ListOf::any_number, last_factor};
  return Either{{Whole{1, most_load_steps, too_many}, factors}, "a whole number ≥ 1 or a list of factors"};
}

Schema penalty() {
  Word automatic = one_of(words::penalty);
  automatic.expected = penalty_number.words;
  return Either{{Number{penalty_number}, automatic}, penalty_number.words};
}

KeySet solver() {
  const SolverOptions standard;
  Word preset;
  for (const Preset& one : presets()) preset.words.push_back(one.name);
  return {
      {may("preset", preset,
           "a name for values of the other keys, which overrule it: paper is the paper's route",
           presets().front().name),
       may("tolerance", Number{below_one}, "relative, on every entry of the certificate", standard.tolerance),
       may("outer", one_of(words::outer), "the linearisation", word_of(standard.outer, words::outer)),
       may("contact", one_of(words::contact), "the method for contact",
           word_of(standard.contact, words::contact)),
       may("r", penalty(), "the penalty, stress over length: balanced, r*, a number, or a published rule",
           word_of(standard.penalty, words::penalty)),
       may("first_r", Number{positive}, "the first penalty, where r names a rule that changes it"),
       may("stop", one_of(words::stop), "what ends a run: KKT residuals or the paper's size of a step",
           word_of(standard.stop, words::stop)),
       may("max_outer", Whole{1}, "outer steps of a load step, or of a part of one", standard.max_outer),
       may("max_contact", Whole{1}, "contact iterations within an outer step", standard.max_contact),
       may("max_cg", Whole{1}, "conjugate-gradient iterations of one linear solve", standard.max_cg),
       may("spectrum_tolerance", Number{below_one}, "relative, on λ_min and λ_max",
           standard.spectrum_tolerance),
       may("relaxation", Number{over_relaxation},
           "over-relaxation of ADMM; left out, 1 with r or stop as in the paper, else 1.7"),
       may("preconditioner", one_of(words::preconditioner), "of the linear solves",
           word_of(standard.preconditioner, words::preconditioner)),
       may("coarse_amg", Whole{0},
           "aggregates: a level of at most so many is handed to BoomerAMG; 0: none is", standard.coarse_amg),
       may("load_steps", load_steps(), "how many, or factors > 0 of which the last is 1", 1),
       may("nested", Flag{}, "whether coarser meshes are solved first, where there are some",
           standard.nested)}};
}

KeySet output() {
  const OutputOptions standard;
  return {
      {may("fields", one_of(words::fields), "files for ParaView", word_of(standard.fields, words::fields)),
       may("steps", Flag{}, "fields of the load steps before the last, too", standard.steps),
       may("report", Flag{}, "pictures and summary", standard.report),
       may("scale", Number{positive}, "of displacements in pictures; else chosen"),
       may("view", ListOf{Number{}, "a list of 3 numbers", 3, 3}, "direction from the body to the eye; 3D"),
       may("quantity", one_of(words::quantity), "what colours picture and page",
           word_of(standard.quantity, words::quantity)),
       may("checkpoint", Flag{}, "files that an unfinished run goes on from", standard.checkpoint)}};
}

KeySet top() {
  const Schema materials =
      ListOf{material(), "a list of materials", 1, ListOf::any_number, "at least one material"};
  return {
      {must("mesh", mesh(), "where the mesh comes from: a file or a box"),
       may("plane", one_of(words::plane),
           "of meshes in 2D: plane strain, plane stress, or a section x ≥ 0 that goes round the axis x = 0",
           word_of(Model().plane, words::plane)),
       may("thickness", Number{positive}, "of plane strain and plane stress: what forces are of",
           Model().thickness),
       must("material", materials, "elastic constants and laws; every element needs exactly one"),
       may("boundary", ListOf{boundary(), "a list of boundary conditions"}, "supports and loads"),
       may("contact", ListOf{contact(), "a list of contact entries"},
           "facets and the obstacles that they face"),
       may("steps", steps(), "load curves; not with solver.load_steps"),
       may("solver", solver(), "how it is solved"),
       may("probe", ListOf{vector_schema(), "a list of points"},
           "points of the body whose displacement is reported"),
       may("output", output(), "what is written"), may("title", Text{true}, "for people"),
       may("$schema", Text{}, "for editors: where the schema is that kacanov schema prints")}};
}

}  // namespace

Schema vector_schema() { return Schema(ListOf{Number{}, "a list of 2 or 3 numbers", 2, 3}).named("vector"); }
Schema axes_schema() { return ListOf{vector_schema(), "a list of 2 or 3 axes", 2, 3}; }

const Schema& case_schema() {
  static const Schema schema = top();
  return schema;
}

nlohmann::ordered_json case_json_schema() {
  return json_schema(
      case_schema(),
      {{"title", "kacanov case file"},
       {"description",
        "What kacanov solves, in any consistent units: with lengths in mm and forces in N, stresses are "
        "in MPa. Comments, // and /* */, may stand anywhere."}});
}

}  // namespace kacanov
