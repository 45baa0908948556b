// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "lintel/programs/Euroc2Rawlog.h"

int main(int argc, char** argv) { return lintel::runEuroc2Rawlog(argc, argv, std::cout, std::cerr); }
