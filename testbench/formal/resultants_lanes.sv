// SPDX-License-Identifier: MIT OR Apache-2.0
//
// The lanes as the program scheduler of a design without a field sees them: one program, of any length.
module sptfra_spmv_array #(
    // Those of the module that it stands for; it needs none of them
    parameter ROM_DIR = "",
    parameter
    PES = 0, CHANNELS = 0, COEFFICIENT_BITS = 0, DATA_BITS = 0, ELEMENTS = 0, VECTORS = 0,
    WORD_DEPTH = 0, SEGMENT_DEPTH = 0, OPERAND_DEPTH = 0, SLOT_DEPTH = 0, MIRROR_SIDE = 0,
    PRODUCTS = 0, COUNT_BITS = 0, LENGTHS = 0, WAITS = 0, BASES = 0, OF_STRESS = 0, MARKS = 0,
    REWINDS = 0, MIRRORED = 0, FRICTIONS = 0, LASTS = 0, PROGRAMS = 0, FIRSTS = 0, START_WORDS = 0,
    START_SEGMENTS = 0, START_SLOTS = 0, RESIDUAL_BANK = 0, AHEAD = 0, DESTINATION_BITS = 0,
    SHIFTS = 0, LEAST_SHIFT = 0, LARGEST_SHIFT = 0, ROM_NAME = 0, NUMBER_BITS = 0, PE_NUMBERS = 0
) (
    input wire clock,
    input wire reset,
    input wire start,
    output wire issued,
    output wire issuing_now
);

    reg issuing = 1'b0;
    wire go = $anyseq;

    assign issuing_now = issuing;
    assign issued = go && issuing;

    always @(posedge clock) begin
        issuing <= start || (issuing && !issued);
        if (reset) begin
            issuing <= 1'b0;
        end
    end

endmodule
