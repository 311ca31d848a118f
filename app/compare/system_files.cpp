#include "app/compare/system_files.h"

#include "app/base/words.h"
#include "app/compare/plain_system.h"
#include "app/recording/output.h"

namespace drape::app {
namespace {

struct Part {
  const char *file, *what;
};
constexpr Part matrix_file{"A.mtx", "A [kg], symmetric, positive definite, without the constraints"};
constexpr Part right_file{"b.mtx", "b [N s]"};
constexpr Part allowed_file{
    "S.mtx", "S, symmetric, a block of 3 x 3 for each particle: the changes that it is free to make"};
constexpr Part given_file{"z.mtx", "z [m/s], the change that is given in the other directions"};
constexpr Part projected_file{"A-projected.mtx", "S A S + I - S, symmetric, positive definite"};
constexpr Part projected_right_file{"b-projected.mtx", "S (b - A z) [N s]"};
constexpr Part guess_file{"guess.mtx", "dv [m/s] from which the first solve of the step started"};
constexpr Part solution_file{"dv.mtx", "dv [m/s] that the step's own solver found, to the tolerance"};
constexpr Part parts[] = {matrix_file,    right_file,           allowed_file, given_file,
                          projected_file, projected_right_file, guess_file,   solution_file};

// Writes a file in pieces, for its text can be longer than all else in memory.
class Lines {
 public:
  Lines(std::vector<AtomicFile>& files, const std::filesystem::path& path)
      : file_(files.emplace_back(path)) {}
  void add(const std::string& line) {
    text_ += line;
    if (text_.size() > 1000000) flush();
  }
  void close() {
    flush();
    file_.close();
  }

 private:
  void flush() {
    file_.write(text_);
    text_.clear();
  }
  AtomicFile& file_;
  std::string text_;
};

// The lower triangle of a symmetric matrix, numbered from 1; entries that are zero are left out.
void write_matrix(Lines lines, const Part& part, const PlainMatrix& whole) {
  PlainMatrix lower = whole.triangularView<Eigen::Lower>();
  lower.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0; });
  lines.add("%%MatrixMarket matrix coordinate real symmetric\n% " + std::string(part.what) + "\n");
  lines.add(std::to_string(lower.rows()) + " " + std::to_string(lower.cols()) + " " +
            std::to_string(lower.nonZeros()) + "\n");
  for (int column = 0; column < lower.cols(); ++column)
    for (PlainMatrix::InnerIterator entry(lower, column); entry; ++entry)
      lines.add(std::to_string(entry.row() + 1) + " " + std::to_string(column + 1) + " " +
                shortest(entry.value()) + "\n");
  lines.close();
}

void write_vector(Lines lines, const Part& part, const VecX& numbers) {
  lines.add("%%MatrixMarket matrix array real general\n% " + std::string(part.what) + "\n" +
            std::to_string(numbers.size()) + " 1\n");
  for (const double number : numbers) lines.add(shortest(number) + "\n");
  lines.close();
}

PlainMatrix block_diagonal(const std::vector<Mat3>& blocks) {
  const auto n = 3 * static_cast<int>(blocks.size());
  PlainMatrix all(n, n);
  all.reserve(Eigen::VectorXi::Constant(n, 3));
  for (int i = 0; i < n; ++i)
    for (int row = i - i % 3; row < i - i % 3 + 3; ++row) all.insert(row, i) = blocks[i / 3](row % 3, i % 3);
  all.makeCompressed();
  return all;
}

Json description(const LinearSystem& system, Json::Members about) {
  Json::Members files;
  for (const Part& part : parts) files.emplace_back(part.file, part.what);
  about.emplace_back("particles", system.A.rows());
  about.emplace_back("constrained", static_cast<int>(system.filter.entries().size()));
  about.emplace_back("tolerance", system.options.tolerance);
  about.emplace_back("scale", system.options.scale);
  about.emplace_back("equations", Json::List{"S (A dv - b) = 0, (I - S) dv = z",
                                             "(S A S + I - S) y = S (b - A z), dv = S y + z"});
  about.emplace_back("order", "row 3 i + k is coordinate k of particle i, both from 0");
  about.emplace_back("files", std::move(files));
  return about;
}

}  // namespace

std::vector<AtomicFile> write_system(const std::filesystem::path& folder, const LinearSystem& system,
                                     Json::Members about) {
  make_output_folder(folder);
  std::vector<AtomicFile> files;
  files.reserve(std::size(parts) + 1);  // what is written refers to its element
  const auto lines = [&](const Part& part) { return Lines(files, folder / part.file); };
  const auto by_particle = [&](const VecX& rows) {
    VecX all(rows.size());
    to_particles(system.A.pattern(), rows, all);
    return all;
  };
  const PlainSystem whole = plain_system(system), inside = projected_system(system);
  const PlainFilter filter = plain_filter(system);
  write_matrix(lines(matrix_file), matrix_file, whole.matrix);
  write_vector(lines(right_file), right_file, whole.right);
  write_matrix(lines(allowed_file), allowed_file, block_diagonal(filter.S));
  write_vector(lines(given_file), given_file, filter.z);
  write_matrix(lines(projected_file), projected_file, inside.matrix);
  write_vector(lines(projected_right_file), projected_right_file, inside.right);
  write_vector(lines(guess_file), guess_file, by_particle(system.guess));
  write_vector(lines(solution_file), solution_file, by_particle(system.solution));
  files.emplace_back(folder / "system.json").write(json_text(description(system, std::move(about))));
  files.back().close();
  return files;
}

}  // namespace drape::app
