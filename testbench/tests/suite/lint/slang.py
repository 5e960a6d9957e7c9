# SPDX-License-Identifier: MIT OR Apache-2.0
"""Lets slang read a design as Verilog-2005 with its extra warnings: slang.py TOP FILE... Prints what it has to say."""

import sys

from pyslang.driver import Driver

driver = Driver()
driver.addStandardArgs()
arguments = ["slang", "--std", "1364-2005", "-Wextra", "-Wpedantic", "--top", *sys.argv[1:]]
if not (driver.parseCommandLine(" ".join(arguments)) and driver.processOptions() and driver.parseAllSources()):
    sys.exit("slang could not read the files")
driver.reportCompilation(driver.createCompilation(), True)
