// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The array of SpMV PEs that We, Co and Op share, with its sequencer and its collector.
//
// From the sequencer to the PEs there is one register; so is there from the write port to the operand memories.

`default_nettype none

module sptfra_spmv_array #(
    // PEs, and multiply-accumulates of each in a cycle: 1, or 4 parity components
    parameter PES = 4,
    parameter CHANNELS = 4,
    // Bits of a coefficient, at most 27, and of an operand, at most 35
    parameter COEFFICIENT_BITS = 18,
    parameter DATA_BITS = 27,
    // Elements of a vector: taxels, or orbits of a folded grid
    parameter ELEMENTS = 25,
    // Vectors that a product reads side by side, at most
    parameter VECTORS = 3,
    // Words of the PEs' ROMs: coefficients with their columns, and row segments
    parameter WORD_DEPTH = 512,
    parameter SEGMENT_DEPTH = 64,
    // Words of the operand memories, and of the ROM of write-back slots
    parameter OPERAND_DEPTH = 200,
    parameter SLOT_DEPTH = 200,
    // Orbits along a side of a grid of which some products are mirrored at the diagonal; 0: none is
    parameter MIRROR_SIDE = 0,
    // Products of all programs: see sptfra_spmv_sequencer
    parameter PRODUCTS = 2,
    parameter COUNT_BITS = 12,
    parameter [PRODUCTS*COUNT_BITS-1:0] LENGTHS = {(PRODUCTS*COUNT_BITS){1'b1}},
    parameter [PRODUCTS*COUNT_BITS-1:0] WAITS = {(PRODUCTS*COUNT_BITS){1'b0}},
    parameter [PRODUCTS*16-1:0] BASES = {(PRODUCTS*16){1'b0}},
    parameter [PRODUCTS-1:0] OF_STRESS = {PRODUCTS{1'b0}},
    parameter [PRODUCTS-1:0] MARKS = {PRODUCTS{1'b0}},
    parameter [PRODUCTS-1:0] REWINDS = {PRODUCTS{1'b0}},
    parameter [PRODUCTS-1:0] MIRRORED = {PRODUCTS{1'b0}},
    parameter [PRODUCTS-1:0] FRICTIONS = {PRODUCTS{1'b0}},
    parameter [15:0] RESIDUAL_BANK = 16'd0,
    parameter [PRODUCTS-1:0] LASTS = {1'b1, {(PRODUCTS-1){1'b0}}},
    parameter PROGRAMS = 1,
    parameter [PROGRAMS*8-1:0] FIRSTS = {(PROGRAMS*8){1'b0}},
    parameter [PROGRAMS*32-1:0] START_WORDS = {(PROGRAMS*32){1'b0}},
    parameter [PROGRAMS*16-1:0] START_SEGMENTS = {(PROGRAMS*16){1'b0}},
    parameter [PROGRAMS*32-1:0] START_SLOTS = {(PROGRAMS*32){1'b0}},
    // Results: see sptfra_spmv_collector
    parameter AHEAD = 0,
    parameter DESTINATION_BITS = 4,
    parameter [95:0] SHIFTS = {16{6'd16}},
    // Prefix of the ROM file names, for instance a directory with its slash, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Characters of each PE's number in its files' names, PE 0 in the lowest bits
    parameter NUMBER_BITS = 16,
    parameter [NUMBER_BITS*PES-1:0] PE_NUMBERS = {(NUMBER_BITS*PES){1'b0}},
    // Derived
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter OPERAND_WIDTH = (OPERAND_DEPTH > 2) ? $clog2(OPERAND_DEPTH) : 1
) (
    input  wire clock,
    input  wire reset,
    // Program scheduler
    input  wire [PROGRAMS-1:0] start, // of the programs, one at a time
    output wire issued, // with the last issue of a program
    input  wire bank, // of the stress of the frame whose weights are computed
    input  wire field_bank, // of the residual of the frame whose field is
    // Friction, held while a program that needs it runs
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // Operand memories
    input  wire write_enable,
    input  wire [OPERAND_WIDTH-1:0] write_address,
    input  wire [CHANNELS*DATA_BITS-1:0] write_data,
    // Result bus: of these one bit with each result, none without
    output wire result_y,
    output wire [2:0] result_u, // of components without the stress, which is added to u0
    output wire [8:0] result_g, // of taxels g_pq at 3 (p - 1) + q, of components their sums over the frame at 0
    output wire [3:0] result_kept, // of taxels A_p b at p - 1, of components what is left of the stress: r, r2, r1, r0
    output wire [2:0] result_force, // of components A_p r, the field
    output wire [ROW_WIDTH-1:0] result_row,
    output wire [CHANNELS*DATA_BITS-1:0] result_value, // component 0 in the lowest bits
    output wire result_last // of its program
);

    if ((CHANNELS != 1) && (CHANNELS != 4)) begin : gen_check_channels
        sptfra_error_channels_must_be_1_or_4 invalid ();
    end
    if ((PES < 1) || (PES > 128)) begin : gen_check_pes
        sptfra_error_pes_must_be_1_to_128 invalid ();
    end
    if ((DESTINATION_BITS != 3) && (DESTINATION_BITS != 4)) begin : gen_check_destinations
        sptfra_error_a_destination_has_3_or_4_bits invalid ();
    end
    localparam WORD_WIDTH = (WORD_DEPTH > 2) ? $clog2(WORD_DEPTH) : 1;
    localparam SLOT_WIDTH = (SLOT_DEPTH > 2) ? $clog2(SLOT_DEPTH) : 1;

    // ---- From the sequencer; one register on the way to the PEs
    wire next_restart;
    wire [WORD_WIDTH-1:0] next_start_word;
    wire next_restart_segment;
    wire [15:0] next_start_segment;
    wire [SLOT_WIDTH-1:0] next_start_slot;
    wire next_issue;
    wire next_mark;
    wire next_rewind;
    wire [OPERAND_WIDTH-1:0] next_base;
    wire next_mirrored;
    wire next_friction;
    reg  restart;
    reg  [WORD_WIDTH-1:0] start_word;
    reg  restart_segment;
    reg  [15:0] start_segment;
    reg  [SLOT_WIDTH-1:0] start_slot;
    reg  issue;
    reg  mark;
    reg  rewind;
    reg  [OPERAND_WIDTH-1:0] base;
    reg  mirrored;
    reg  friction;

    always @(posedge clock) begin
        restart <= next_restart;
        start_word <= next_start_word;
        restart_segment <= next_restart_segment;
        start_segment <= next_start_segment;
        start_slot <= next_start_slot;
        issue <= next_issue;
        mark <= next_mark;
        rewind <= next_rewind;
        base <= next_base;
        mirrored <= next_mirrored;
        friction <= next_friction;
        if (reset) begin
            restart <= 1'b0;
            restart_segment <= 1'b0;
            issue <= 1'b0;
            mark <= 1'b0;
            rewind <= 1'b0;
        end
    end

    sptfra_spmv_sequencer #(
        .ELEMENTS       (ELEMENTS),
        .WORD_DEPTH     (WORD_DEPTH),
        .OPERAND_DEPTH  (OPERAND_DEPTH),
        .SLOT_DEPTH     (SLOT_DEPTH),
        .PRODUCTS       (PRODUCTS),
        .COUNT_BITS     (COUNT_BITS),
        .LENGTHS        (LENGTHS),
        .WAITS          (WAITS),
        .BASES          (BASES),
        .OF_STRESS      (OF_STRESS),
        .MARKS          (MARKS),
        .REWINDS        (REWINDS),
        .MIRRORED       (MIRRORED),
        .FRICTIONS      (FRICTIONS),
        .RESIDUAL_BANK  (RESIDUAL_BANK),
        .LASTS          (LASTS),
        .PROGRAMS       (PROGRAMS),
        .FIRSTS         (FIRSTS),
        .START_WORDS    (START_WORDS),
        .START_SEGMENTS (START_SEGMENTS),
        .START_SLOTS    (START_SLOTS)
    ) sequencer (
        .clock           (clock),
        .reset           (reset),
        .start           (start),
        .issued          (issued),
        .bank            (bank),
        .field_bank      (field_bank),
        .restart         (next_restart),
        .start_word      (next_start_word),
        .restart_segment (next_restart_segment),
        .start_segment   (next_start_segment),
        .start_slot      (next_start_slot),
        .issue           (next_issue),
        .mark            (next_mark),
        .rewind          (next_rewind),
        .base            (next_base),
        .mirrored        (next_mirrored),
        .friction        (next_friction)
    );

    // ---- One register on the way to the operand memories
    reg operand_write;
    reg [OPERAND_WIDTH-1:0] operand_address;
    reg [CHANNELS*DATA_BITS-1:0] operand_data;

    always @(posedge clock) begin
        operand_write <= write_enable;
        operand_address <= write_address;
        operand_data <= write_data;
        if (reset) begin
            operand_write <= 1'b0;
        end
    end

    // ---- PEs
    wire [48*CHANNELS*PES-1:0] results;
    wire [48*CHANNELS*PES-1:0] carries;
    wire [PES-1:0] pending;
    wire [PES-1:0] take;

    genvar index;
    for (index = 0; index < PES; index = index + 1) begin : gen_pes
        localparam [NUMBER_BITS-1:0] NUMBER = PE_NUMBERS[NUMBER_BITS*index +: NUMBER_BITS];
        localparam [7:0] NEXT = (index + 1) % PES;

        sptfra_spmv_pe #(
            .CHANNELS         (CHANNELS),
            .COEFFICIENT_BITS (COEFFICIENT_BITS),
            .DATA_BITS        (DATA_BITS),
            .ELEMENTS         (ELEMENTS),
            .VECTORS          (VECTORS),
            .WORD_DEPTH       (WORD_DEPTH),
            .SEGMENT_DEPTH    (SEGMENT_DEPTH),
            .OPERAND_DEPTH    (OPERAND_DEPTH),
            .MIRROR_SIDE      (MIRROR_SIDE),
            .FRICTION         (FRICTIONS != {PRODUCTS{1'b0}}),
            .ROM_DIR          (ROM_DIR),
            .VALUES_FILE      ((ROM_NAME == "") ? "" : {ROM_NAME, "_values_pe", NUMBER, ".mem"}),
            .COLUMNS_FILE     ((ROM_NAME == "") ? "" : {ROM_NAME, "_columns_pe", NUMBER, ".mem"}),
            .MACS_FILE        ((ROM_NAME == "") ? "" : {ROM_NAME, "_macs_pe", NUMBER, ".mem"})
        ) pe (
            .clock           (clock),
            .reset           (reset),
            .restart         (restart),
            .start_word      (start_word),
            .restart_segment (restart_segment),
            .start_segment   (start_segment),
            .issue           (issue),
            .mark            (mark),
            .rewind          (rewind),
            .base            (base),
            .mirrored        (mirrored),
            .friction        (friction),
            .mu_x            (mu_x),
            .mu_y            (mu_y),
            .write_enable    (operand_write),
            .write_address   (operand_address),
            .write_data      (operand_data),
            .next_carry      (carries[48*CHANNELS*NEXT +: 48*CHANNELS]),
            .carry           (carries[48*CHANNELS*index +: 48*CHANNELS]),
            .result          (results[48*CHANNELS*index +: 48*CHANNELS]),
            .pending         (pending[index]),
            .take            (take[index])
        );
    end

    sptfra_spmv_collector #(
        .PES              (PES),
        .CHANNELS         (CHANNELS),
        .DATA_BITS        (DATA_BITS),
        .ELEMENTS         (ELEMENTS),
        .MIRROR           (MIRROR_SIDE > 0),
        .AHEAD            (AHEAD),
        .DESTINATION_BITS (DESTINATION_BITS),
        .SHIFTS           (SHIFTS),
        .SLOT_DEPTH       (SLOT_DEPTH),
        .ROM_DIR          (ROM_DIR),
        .SLOTS_FILE       ((ROM_NAME == "") ? "" : {ROM_NAME, "_slots.mem"})
    ) collector (
        .clock        (clock),
        .reset        (reset),
        .restart      (restart),
        .start_slot   (start_slot),
        .results      (results),
        .pending      (pending),
        .take         (take),
        .result_y     (result_y),
        .result_u     (result_u),
        .result_g     (result_g),
        .result_kept  (result_kept),
        .result_force (result_force),
        .result_row   (result_row),
        .result_value (result_value),
        .result_last  (result_last)
    );

endmodule

`default_nettype wire
