#include "app/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <new>

#include "app/base/interrupt.h"
#include "app/base/words.h"
#include "app/commands/check.h"
#include "app/commands/commands.h"
#include "app/commands/fit.h"
#include "app/commands/keys.h"
#include "app/commands/triangulate_command.h"
#include "app/commands/untangle.h"
#include "app/compare/compare.h"
#include "app/export/export.h"
#include "app/picture/picture.h"
#include "app/run/drop.h"
#include "app/stability/stability.h"
#include "app/textile/test_fabric.h"
#include "app/view/view.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

// What `simulate` and `drop` share, as the command line gives it.
struct RunWords {
  std::string out, frames = "pc2";
  bool quiet = false;
  std::vector<std::string> settings, more_settings;
  std::map<std::string, std::string> overrides;  // path of the scene -> value

  CommonOptions common(const CLI::App& command) const {
    CommonOptions options;
    options.out = out;
    options.quiet = quiet;
    options.frames = frames == "obj" ? Frames::obj : frames == "none" ? Frames::none : Frames::pc2;
    for (const std::string& text : settings) options.settings.push_back(parse_setting(text, "--set"));
    for (const std::string& text : more_settings) options.settings.push_back(parse_setting(text, ""));
    for (const auto& [path, value] : overrides) {
      std::string option = "--" + path.substr(path.find('.') + 1);
      for (char& c : option) c = c == '_' ? '-' : c;
      if (command.count(option) > 0) options.settings.push_back({path, value, option});
    }
    return options;
  }
};

// Those that every command with a scene has.
void add_scene_options(CLI::App& command, RunWords& words) {
  const auto override_of = [&](const std::string& option, const std::string& path, const char* help,
                               const char* type) {
    command.add_option(option, words.overrides[path], help)->type_name(type);
  };
  override_of("--threads", "simulation.threads", "how many threads (as many as processors)", "N");
  override_of("--time-step", "simulation.time_step", "length of a step, such as 0.01 or \"5 ms\"", "TIME");
  override_of("--integrator", "simulation.integrator", "see 'drape list'", "NAME");
  override_of("--linear-solver", "simulation.linear_solver", "see 'drape list'", "NAME");
  override_of("--tolerance", "simulation.tolerance", "relative residual of the linear solve", "X");
  command
      .add_option("--set", words.settings,
                  "changes a value of the scene, such as cloth.0.bend=\"5 uN.m\"; as often as needed")
      ->type_name("PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("more", words.more_settings, "further PATH=VALUE, after --set")->group("");
  command.add_flag("--quiet", words.quiet, "nothing but errors");
}

void add_run_options(CLI::App& command, RunWords& words) {
  command.add_option("--out", words.out, "output folder (out/NAME)")->type_name("DIR");
  command
      .add_option("--duration", words.overrides["simulation.duration"],
                  "time to simulate, such as 2 or \"500 ms\"")
      ->type_name("TIME");
  command.add_option("--frames", words.frames, "how frames are written: pc2, obj or none")
      ->check(CLI::IsMember({"pc2", "obj", "none"}))
      ->type_name("KIND");
  add_scene_options(command, words);
}

void add_simulate(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("simulate", "runs a scene");
  auto scene = std::make_shared<std::string>();
  auto words = std::make_shared<RunWords>();
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  add_run_options(*command, *words);
  command->callback([=, &exit_code] { exit_code = simulate(*scene, words->common(*command)); });
}

void add_drop(CLI::App& app, const std::string& label, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("drop", "lets a cloth fall, onto a body or a floor, without a scene file");
  struct Words {
    std::string cloth, scale, friction, margin;
    DropOptions options;
    RunWords run;
  };
  auto words = std::make_shared<Words>();
  command
      ->add_option("CLOTH", words->cloth,
                   "OBJ file, starting where it stands, or a flat pattern (.svg, .toml)")
      ->required();
  command
      ->add_option("--onto", words->options.onto,
                   "an OBJ file, where it stands, or a shape just under the cloth: " + onto_examples())
      ->type_name("BODY");
  command->add_flag("--floor", words->options.floor, "a plane under the body, or 0.5 m under the cloth");
  command
      ->add_option("--fabric", words->options.fabric,
                   "see 'drape list' (cotton-poplin), or a fabric file (.toml)")
      ->type_name("NAME");
  command->add_option("--scale", words->scale, "of both meshes, such as 0.01 for files in cm")
      ->type_name("X");
  command->add_option("--friction", words->friction, "coefficient of friction of body and floor")
      ->type_name("MU");
  command->add_option("--margin", words->margin, "distance kept from body and floor, such as \"2 mm\"")
      ->type_name("LENGTH");
  command
      ->add_option("--pin", words->options.pinned_groups,
                   "group of the OBJ file that is held; as often as needed")
      ->type_name("GROUP")
      ->take_all()
      ->allow_extra_args(false);
  add_run_options(*command, words->run);
  command->callback([=, &exit_code] {
    DropOptions& options = words->options;
    options.cloth = words->cloth;
    if (command->count("--scale") > 0) options.scale = words->scale;
    if (command->count("--friction") > 0) options.friction = words->friction;
    if (command->count("--margin") > 0) options.margin = words->margin;
    exit_code = drop(options, words->run.common(*command), label);
  });
}

void add_compare(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("compare",
                         "gives the same systems to several linear solvers, and a scene to several "
                         "integrators");
  struct Words {
    std::string scene;
    CompareWords compare;
    RunWords run;
  };
  auto words = std::make_shared<Words>();
  command->add_option("SCENE", words->scene, "scene file (TOML); not needed with --sizes");
  const auto option = [&](const char* name, std::string& value, const char* type, const char* help) {
    command->add_option(name, value, help)->type_name(type);
  };
  CompareWords& compare_words = words->compare;
  option(
      "--solvers", compare_words.solvers, "NAME[@TOLERANCE],...",
      "linear solvers, see 'drape list' (all); NAME@TOLERANCE stops at its own, but is judged by the common");
  option("--steps", compare_words.steps, "N", "how many steps are run (50, with --sizes 30)");
  option("--at", compare_words.at, "N,...", "steps that are compared (first, middle, last)");
  option("--repeats", compare_words.repeats, "N", "timed solves of each system, after the first (3)");
  option("--integrators", compare_words.integrators, "NAME,...",
         "runs of these from the same start, see 'drape list'");
  option("--time-steps", compare_words.time_steps, "TIME,...",
         "of the integrators' runs (the scene's, 1/2 and 1/4 of it)");
  option("--sizes", compare_words.sizes, "N,...",
         "a generated hung sheet of so many vertices instead: 1k,10k,40k");
  command->add_flag("--save-systems", compare_words.save_systems,
                    "also write the systems of the compared steps, constraints and all, for other programs");
  command->add_option("--out", words->run.out, "output folder (out/compare/NAME)")->type_name("DIR");
  add_scene_options(*command, words->run);
  command->footer(
      "The scene's linear solver (--linear-solver) decides the path. Exit code: 0 all solvers agree; 1 a "
      "verdict is 'differ',\nor the run or one of an integrator failed; 2 bad input; 130 interrupted, and "
      "nothing is written.");
  command->callback(
      [=, &exit_code] { exit_code = compare(words->scene, words->compare, words->run.common(*command)); });
}

void add_stability(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("stability", "finds the largest stable step of each integrator in a scene");
  struct Words {
    std::string scene;
    StabilityWords stability;
    RunWords run;
  };
  auto words = std::make_shared<Words>();
  command->add_option("SCENE", words->scene, "scene file (TOML)")->required();
  const auto option = [&](const char* name, std::string& value, const char* type, const char* help) {
    command->add_option(name, value, help)->type_name(type);
  };
  StabilityWords& w = words->stability;
  option("--time", w.time, "TIME", "of every run (the scene's duration)");
  option("--integrators", w.integrators, "NAME,...",
         "see 'drape list' (all but those that choose their own steps)");
  option("--longest", w.longest, "TIME", "no step is tried beyond (a tenth of the time)");
  option("--shortest", w.shortest, "TIME", "nor below (a 50000th of the time)");
  option("--precision", w.precision, "X", "of the steps that are found (0.01)");
  option("--growth", w.growth, "X",
         "energy that may be made, as a multiple of what the motion was given (1)");
  option("--shake", w.shake, "SPEED",
         "random velocities that every particle has at first, so that there is something to grow (1 mm/s)");
  command->add_option("--out", words->run.out, "output folder (out/stability/NAME)")->type_name("DIR");
  add_scene_options(*command, words->run);
  command->callback([=, &exit_code] {
    exit_code = stability(words->scene, words->stability, words->run.common(*command));
  });
}

void add_test_fabric(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "test-fabric", "makes the tests of a textile laboratory with simulated specimens of a fabric");
  struct Words {
    TestFabricWords words;
    std::string out;
    bool quiet = false;
  };
  auto words = std::make_shared<Words>();
  TestFabricWords& w = words->words;
  const auto option = [&](const char* name, std::string& value, const char* type, const char* help) {
    command->add_option(name, value, help)->type_name(type);
  };
  command->add_option("FABRIC", w.fabric, "see 'drape list'")->required();
  option("--mesh", w.mesh, "LENGTH,...", "longest edge of the meshes (10 mm,5 mm)");
  option("--tests", w.tests, "NAME,...", "of cantilever, tensile, shear, drape (all)");
  option("--model", w.model, "NAME", "woven or noh-jung (woven)");
  option("--repeats", w.repeats, "N", "how many specimens are draped on each mesh (3)");
  option("--bending", w.bending, "NAME", "of woven: plate, hinges or quadratic-hinges (plate)");
  option("--specimen", w.specimen, "LENGTH",
         "diameter of the draped disc (as in the fabric's file, else 30 cm)");
  option("--plate", w.plate, "LENGTH",
         "diameter of the plate that it lies on (as in the fabric's file, else 18 cm)");
  option("--lowering", w.lowering, "TIME", "how long the draped disc is let down (5 s)");
  command->add_flag("--hysteresis", w.hysteresis, "the threads rub when they are bent, as kes.2HB says");
  option("--out", words->out, "DIR", "output folder (out/test-fabric/FABRIC)");
  command->add_flag("--quiet", words->quiet, "nothing but errors");
  command->callback([=, &exit_code] { exit_code = test_fabric(words->words, words->out, words->quiet); });
}

void add_level_set(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("level-set", "makes a grid of the distances to a closed mesh, a .vdb file");
  auto words = std::make_shared<LevelSetWords>();
  command->add_option("BODY", words->mesh, "OBJ file of a closed body")->required();
  command->add_option("-o,--out", words->out, "the .vdb file")->type_name("FILE")->required();
  command->add_option("--voxel", words->voxel, "spacing of the grid, such as \"5 mm\" (chosen from the mesh)")
      ->type_name("LENGTH");
  command->add_option("--scale", words->scale, "of the mesh, such as 0.01 for files in cm")->type_name("X");
  command->callback([=, &exit_code] { exit_code = make_level_set(*words); });
}

void add_triangulate(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("triangulate", "makes a mesh of a sewing pattern, an OBJ file");
  auto words = std::make_shared<TriangulateWords>();
  command
      ->add_option("PATTERN", words->pattern, "a drawing (SVG, with the size of its page) or polygons (TOML)")
      ->required();
  command->add_option("-o,--out", words->out, "the OBJ file")->type_name("FILE")->required();
  command
      ->add_option("--edge", words->edge, "no edge is longer, such as \"1 cm\" (1/40 of the pattern's size)")
      ->type_name("LENGTH");
  command->add_option("--min-angle", words->min_angle, "no angle is smaller, in degrees, up to 33 (28)")
      ->type_name("ANGLE");
  command
      ->add_option("--tolerance", words->tolerance,
                   "how far from a curved side the mesh may be (1/50 of the edge)")
      ->type_name("LENGTH");
  command->add_flag("--quiet", words->quiet, "nothing but errors");
  command->callback([=, &exit_code] { exit_code = triangulate_file(*words); });
}

void add_untangle(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "untangle", "brings a mesh apart where it passes through itself, and changes as little else as it can");
  auto words = std::make_shared<UntangleWords>();
  command->add_option("MESH", words->mesh, "OBJ file; its sheets may be several")->required();
  command->add_option("-o,--out", words->out, "the OBJ file")->type_name("FILE")->required();
  const auto option = [&](const char* name, std::string& value, const char* type, const char* help) {
    command->add_option(name, value, help)->type_name(type);
  };
  option("--fabric", words->fabric, "NAME", "see 'drape list' (cotton-poplin), or a fabric file (.toml)");
  option("--thickness", words->thickness, "LENGTH", "how far apart layers come (the fabric's, else 1 mm)");
  option("--scale", words->scale, "X", "of the mesh, such as 0.01 for files in cm; it is written as it was");
  command
      ->add_option("--layers", words->layers,
                   "groups of the mesh from the inside out, such as shirt,pocket: of two that cross the "
                   "outer one comes out "
                   "where the normals of the inner one point")
      ->type_name("GROUP,...")
      ->delimiter(',');
  option("--duration", words->duration, "TIME", "given up after so much simulated time (10 s)");
  command->add_flag("--weld", words->weld,
                    "join vertices at one place, as of seams that were sewn; all are written");
  command->add_flag("--quiet", words->quiet, "nothing but errors");
  command->footer(
      "Exit code: 0 nothing crosses any more; 1 something still does; 2 bad input; 130 interrupted.");
  command->callback([=, &exit_code] { exit_code = untangle_file(*words); });
}

void add_view(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("view", "makes an output folder one HTML file that plays it in a browser, offline");
  auto words = std::make_shared<ViewWords>();
  command->add_option("OUT", words->folder, "output folder of a run")->required();
  command->add_option("-o,--out", words->out, "the page (OUT/view.html)")->type_name("FILE");
  command->add_flag("--force", words->force, "replace a file that is there");
  command->callback([=, &exit_code] { exit_code = view(*words); });
}

void add_picture(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("picture", "draws an output folder or a mesh as PNG");
  auto words = std::make_shared<PictureWords>();
  command
      ->add_option("OUT", words->inputs,
                   "output folder of a run, or an OBJ file drawn as a cloth; several are drawn side by side")
      ->required();
  command->add_option("--with", words->with, "an OBJ file, drawn as a body; as often as needed")
      ->type_name("BODY.obj")
      ->take_all()
      ->allow_extra_args(false);
  const auto option = [&](const char* name, std::string& value, const char* type, const char* help) {
    command->add_option(name, value, help)->type_name(type);
  };
  option("-o,--out", words->out, "FILE", "the picture (OUT/picture.png, or beside the mesh)");
  option("--frame", words->frame, "N",
         "a frame of the run from 1, 'last', 'all', or several: 1,5,last (last)");
  option("--view", words->view, "SIDE",
         "front, back, left, right, side, top, or degrees round and above, such as 30,20 (30,20)");
  option("--color", words->color, "WHAT", "what colours show: strain, speed, contact or crossing");
  option("--size", words->size, "WxH", "of the picture in pixels (1280x960)");
  command->add_flag("--whole", words->whole,
                    "all of the bodies in the picture, not only what is near the cloth");
  command->add_flag("--grid", words->grid, "frames side by side on one sheet (12 when none are named)");
  command->add_flag("--edges", words->edges, "the edges of the triangles, too");
  command->add_flag("--force", words->force, "replace a file that is there");
  command->callback([=, &exit_code] { exit_code = picture(*words); });
}

void add_export(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("export", "writes an output folder in a format of another program");
  auto words = std::make_shared<ExportWords>();
  command->add_option("OUT", words->folder, "output folder of a run")->required();
  command->add_option("--to", words->to, listed(export_formats()))->type_name("FORMAT")->required();
  command->add_option("-o,--out", words->out, "folder of the files (OUT/export)")->type_name("DIR");
  command->add_option("--every", words->every, "every so many frames (1)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
  command->add_flag("--force", words->force, "replace files that are there");
  command->callback([=, &exit_code] { exit_code = export_folder(*words); });
}

void add_fit(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "fit",
      "makes the parameters of a fabric from what a laboratory measured, by formulas and virtual tests");
  auto words = std::make_shared<FitWords>();
  command->add_option("FABRIC", words->out, "the fabric file to write, .toml (printed)");
  const auto option = [&](const char* name, std::string& value, const char* type, const char* help) {
    return command->add_option(name, value, help)->type_name(type);
  };
  option("--from", words->from, "FILE", "a fabric file with bending_length, kes, measured_drape and so on")
      ->required();
  option("--mesh", words->mesh, "LENGTH", "longest edge of the meshes of virtual tests (10 mm)");
  option("--repeats", words->repeats, "N", "how many specimens a virtual drape test takes (3)");
  option(
      "--parameters", words->parameters, "NAME,...",
      "what virtual tests give, of bend, bend.warp, bend.weft, bend.bias, stretch.shear (what is measured)");
  command->add_flag("--quiet", words->quiet, "nothing but errors and the fabric");
  command->add_flag("--force", words->force, "replace a file that is there");
  command->callback([=, &exit_code] { exit_code = fit(*words); });
}

void add_check_and_list(CLI::App& app, int& exit_code) {
  CLI::App* const check = app.add_subcommand("check",
                                             "validates a scene or a fabric file, examines a mesh, or looks "
                                             "for crossings in a run; changes nothing that is there");
  auto file = std::make_shared<std::string>();
  auto mark = std::make_shared<std::string>();
  check->add_option("FILE", *file, "scene or fabric (.toml), mesh (.obj), or output folder of a run")
      ->required();
  check->add_option("--mark", *mark, "writes what crosses into it as OBJ, its faces in the group 'crossing'")
      ->type_name("FOLDER");
  check->callback([=, &exit_code] { exit_code = check_file(*file, *mark); });
  CLI::App* const list =
      app.add_subcommand("list", "fabrics, shapes, forces, integrators and linear solvers of this build");
  auto which = std::make_shared<std::string>();
  auto markdown = std::make_shared<bool>(false);
  list->add_option("KIND", *which, "such as fabrics or \"linear solvers\" (all)");
  list->add_flag("--markdown", *markdown, "as tables in Markdown");
  list->callback([=, &exit_code] { exit_code = list_parts(*which, *markdown); });
}

void add_keys(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("keys", "what may stand in scene, fabric and pattern files, and what it means");
  auto words = std::make_shared<KeysWords>();
  command->add_option("TABLE", words->table,
                      "such as cloth or obstacle; or all of a file: scene, fabric, pattern (everything)");
  command->add_flag("--markdown", words->markdown, "as tables in Markdown");
  command->callback([=, &exit_code] { exit_code = print_keys(*words); });
}

void check_command(const CLI::App& app, const std::string& word) {
  Names known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), word) == known.end())
    throw InputError("there is no command '" + word + "'; " + suggestion(word, known));
}

// No command takes an empty word; each would read it as something else: no option given, the current folder.
void check_words(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i], before = i > 1 ? argv[i - 1] : "drape";
    if (word.empty()) throw InputError("the word after '" + before + "' is empty");
    if (word.starts_with("--") && word.find('=') == word.size() - 1)
      throw InputError("there is nothing after '" + word + "'");
  }
}

int parse_and_run(int argc, char** argv) {
  check_words(argc, argv);
  int exit_code = 0;
  std::string label = "drape";
  for (int i = 1; i < argc; ++i) label += " " + std::string(argv[i]);
  CLI::App app("drape: an implicit cloth solver", "drape");
  app.set_version_flag("--version", "drape " DRAPE_VERSION);
  app.require_subcommand(1);
  add_simulate(app, exit_code);
  add_drop(app, label, exit_code);
  add_compare(app, exit_code);
  add_stability(app, exit_code);
  add_test_fabric(app, exit_code);
  add_level_set(app, exit_code);
  add_triangulate(app, exit_code);
  add_untangle(app, exit_code);
  add_view(app, exit_code);
  add_picture(app, exit_code);
  add_export(app, exit_code);
  add_fit(app, exit_code);
  add_check_and_list(app, exit_code);
  add_keys(app, exit_code);
  if (argc > 1 && argv[1][0] != '-') check_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    throw InputError(std::string(error.what()) + "; see drape --help, drape COMMAND --help");
  }
  return exit_code;
}

// run.json names files in UTF-8, and a name in anything else could not be found again.
void check_encoding(int argc, char** argv) {
  for (int k = 1; k < argc; ++k)
    if (!is_utf8(argv[k]))
      throw InputError("word " + std::to_string(k) +
                       " of the command is not UTF-8; give the file a name that is");
}

int fail(int exit_code, const std::string& what) {
  std::fprintf(stderr, "error: %s\n", one_line(what).c_str());
  return exit_code;
}

}  // namespace

int command_line(int argc, char** argv) {
  try {
    check_encoding(argc, argv);
    const int exit_code = parse_and_run(argc, argv);
    if (exit_code == 0) check_printed();
    return exit_code;
  } catch (const InputError& error) {
    return fail(2, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(2, error.path1().string() + ": " + error.code().message());
  } catch (const std::bad_alloc&) {
    fail(1, "there is not enough memory for this; use a coarser mesh");
    std::fflush(nullptr);
    std::_Exit(1);  // OpenBLAS, at the end of a program, waits for ever for a thread that finds no memory
  } catch (const std::exception& error) {
    return fail(1, std::string("the program failed: ") + error.what());
  }
}

}  // namespace drape::app
