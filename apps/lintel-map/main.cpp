// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelMap.h"

#include <iostream>

int main(int argc, char** argv) { return lintel::runLintelMap(argc, argv, std::cout, std::cerr); }
