// Makes the tables of documents new from the JSON lines beside them (result_tables.hpp).
// Run: bench_tables docs/*.md; the results lie in docs/results.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>

#include "result_tables.hpp"

int main(int argc, char** argv) {
    try {
        for (int i = 1; i < argc; ++i) {
            const std::filesystem::path file = argv[i];
            std::ifstream in(file);
            const std::string before{std::istreambuf_iterator<char>(in), {}};
            if (!in) throw std::runtime_error(file.string() + ": cannot be read");
            const auto made = pfvox::bench::withTables(before, file.parent_path() / "results");
            for (const std::string& absent : made.absent)
                std::printf("%s: no results/%s yet, its table stays\n", argv[i], absent.c_str());
            if (made.text == before) continue;
            if (!(std::ofstream(file) << made.text))
                throw std::runtime_error(file.string() + ": cannot be written");
            std::printf("%s: %zu tables made\n", argv[i], made.tables);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_tables: %s\n", error.what());
        return 1;
    }
    return 0;
}
