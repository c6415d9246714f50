// Everything that was installed, at once.
#include <softtissue/softtissue.hpp>

int main() { return softtissue::Tet4::num_nodes == 4 ? 0 : 1; }
