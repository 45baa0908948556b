// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "lintel/programs/LintelSim.h"

int main(int argc, char** argv) { return lintel::runLintelSim(argc, argv, std::cout, std::cerr); }
