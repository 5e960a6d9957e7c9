// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The array of SpMV PEs that We, Co and Op share, with its collector. It issues products in a fixed order and at fixed
// times.
//
// A start pulse runs one program: products that follow each other at fixed distances. issued marks the last issue of a
// program. The next start may come in the cycle after that. Control takes one register to the PEs, writes take
// one to the operand memories.

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
    // Products of all programs, and their tables: number 0 stands in the lowest bits
    parameter PRODUCTS = 2,
    // Bits of a count of cycles
    parameter COUNT_BITS = 12,
    // Issue cycles of a product, and cycles to wait before it, until its operand is complete
    parameter [PRODUCTS*COUNT_BITS-1:0] LENGTHS = {(PRODUCTS*COUNT_BITS){1'b1}},
    parameter [PRODUCTS*COUNT_BITS-1:0] WAITS = {(PRODUCTS*COUNT_BITS){1'b0}},
    // First word of its operand in the PEs' memories, unless that is the frame's stress
    parameter [PRODUCTS*16-1:0] BASES = {(PRODUCTS*16){1'b0}},
    parameter [PRODUCTS-1:0] OF_STRESS = {PRODUCTS{1'b0}},
    // Products whose matrix is read again, those that read it again, and those for which the diagonal mirror is meant
    parameter [PRODUCTS-1:0] MARKS = {PRODUCTS{1'b0}},
    parameter [PRODUCTS-1:0] REWINDS = {PRODUCTS{1'b0}},
    parameter [PRODUCTS-1:0] MIRRORED = {PRODUCTS{1'b0}},
    // Products whose coefficients are friction components: of the residual, which stands so many words further in its
    // other bank, if it has two
    parameter [PRODUCTS-1:0] FRICTIONS = {PRODUCTS{1'b0}},
    parameter [15:0] RESIDUAL_BANK = 16'd0,
    // Last products of their programs
    parameter [PRODUCTS-1:0] LASTS = {1'b1, {(PRODUCTS-1){1'b0}}},
    // Programs, and the first product of each
    parameter PROGRAMS = 1,
    parameter [PROGRAMS*8-1:0] FIRSTS = {(PROGRAMS*8){1'b0}},
    // Addresses at which their data begin in the ROMs of words, of row segments and of write-back slots
    parameter [PROGRAMS*32-1:0] START_WORDS = {(PROGRAMS*32){1'b0}},
    parameter [PROGRAMS*16-1:0] START_SEGMENTS = {(PROGRAMS*16){1'b0}},
    parameter [PROGRAMS*32-1:0] START_SLOTS = {(PROGRAMS*32){1'b0}},
    // Results: see sptfra_spmv_collector
    parameter AHEAD = 0,
    parameter DESTINATION_BITS = 4,
    parameter [95:0] SHIFTS = {16{6'd16}},
    parameter LEAST_SHIFT = 16,
    parameter LARGEST_SHIFT = 16,
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
    if (!LASTS[PRODUCTS-1]) begin : gen_check_last
        sptfra_error_the_last_product_must_end_its_program invalid ();
    end

    localparam WORD_WIDTH = (WORD_DEPTH > 2) ? $clog2(WORD_DEPTH) : 1;
    localparam SLOT_WIDTH = (SLOT_DEPTH > 2) ? $clog2(SLOT_DEPTH) : 1;
    localparam PRODUCT_WIDTH = (PRODUCTS > 2) ? $clog2(PRODUCTS) : 1;
    localparam [1:0] IDLE = 2'd0, WAIT = 2'd1, RUN = 2'd2;
    localparam [COUNT_BITS-1:0] ONE = 1;
    localparam [31:0] SECOND_BANK = ELEMENTS;

    // ---- The program that is started: what is known of its first product, one cycle behind start
    wire starts = (start != {PROGRAMS{1'b0}});
    reg [PRODUCT_WIDTH-1:0] chosen;
    reg [WORD_WIDTH-1:0] chosen_word;
    reg [15:0] chosen_segment;
    reg [SLOT_WIDTH-1:0] chosen_slot;
    reg [PRODUCT_WIDTH-1:0] first_product;
    reg [WORD_WIDTH-1:0] first_word;
    reg [SLOT_WIDTH-1:0] first_slot;
    reg [COUNT_BITS-1:0] first_wait;
    reg [COUNT_BITS-1:0] first_length;
    reg first_is_last;
    integer number;

    always @(*) begin
        chosen = {PRODUCT_WIDTH{1'b0}};
        chosen_word = {WORD_WIDTH{1'b0}};
        chosen_slot = {SLOT_WIDTH{1'b0}};
        chosen_segment = 16'd0;
        for (number = 0; number < PROGRAMS; number = number + 1) begin
            if (start[number]) begin
                chosen = FIRSTS[8*number +: PRODUCT_WIDTH];
                chosen_word = START_WORDS[32*number +: WORD_WIDTH];
                chosen_slot = START_SLOTS[32*number +: SLOT_WIDTH];
                chosen_segment = START_SEGMENTS[16*number +: 16];
            end
        end
    end

    always @(posedge clock) begin
        first_product <= chosen;
        first_word <= chosen_word;
        first_slot <= chosen_slot;
        first_wait <= WAITS[COUNT_BITS*chosen +: COUNT_BITS];
        first_length <= LENGTHS[COUNT_BITS*chosen +: COUNT_BITS];
        first_is_last <= LASTS[chosen];
    end

    // ---- The next product, all looked up before it is known which is wanted
    reg [1:0] state;
    reg [PRODUCT_WIDTH-1:0] product;
    reg [COUNT_BITS-1:0] count;
    reg over; // count is 1
    reg first_issue;
    reg started; // one cycle behind start, with the program's data
    reg program_last;
    wire run = (state == RUN);
    wire run_last = run && over;
    wire advance = started || (run_last && !program_last);
    wire [PRODUCT_WIDTH-1:0] following = product + 1;
    wire [PRODUCT_WIDTH-1:0] next_product = started ? first_product : following;
    wire [COUNT_BITS-1:0] next_wait = started ? first_wait : WAITS[COUNT_BITS*following +: COUNT_BITS];
    wire [COUNT_BITS-1:0] next_length = started ? first_length : LENGTHS[COUNT_BITS*following +: COUNT_BITS];
    wire [COUNT_BITS-1:0] own_length = LENGTHS[COUNT_BITS*product +: COUNT_BITS];
    wire next_last = started ? first_is_last : LASTS[following];

    assign issued = run_last && program_last;

    always @(posedge clock) begin
        started <= starts;
        if (advance) begin
            product <= next_product;
            program_last <= next_last;
            first_issue <= 1'b1;
            if (next_wait != {COUNT_BITS{1'b0}}) begin
                state <= WAIT;
                count <= next_wait;
                over <= (next_wait == ONE);
            end else begin
                state <= RUN;
                count <= next_length;
                over <= (next_length == ONE);
            end
        end else begin
            count <= count - ONE;
            over <= (count == ONE + ONE);
            case (state)
                WAIT: begin
                    if (over) begin
                        state <= RUN;
                        count <= own_length;
                        over <= (own_length == ONE);
                    end
                end
                RUN: begin
                    first_issue <= 1'b0;
                    if (run_last) begin
                        state <= IDLE;
                    end
                end
                default: begin
                    count <= count;
                end
            endcase
        end
        if (reset) begin
            state <= IDLE;
            started <= 1'b0;
        end
    end

    // ---- To the PEs and the collector, a cycle later
    reg restart; // one or two cycles before the first issue of a program, with the addresses of its data
    reg [WORD_WIDTH-1:0] start_word;
    reg [SLOT_WIDTH-1:0] start_slot;
    reg restart_segment; // one cycle before restart, with
    reg [15:0] start_segment;
    reg issue; // one MAC a lane and cycle
    reg mark; // first issue of a matrix that is read again
    reg rewind; // first issue of reading it again
    reg [OPERAND_WIDTH-1:0] base_1;
    reg [OPERAND_WIDTH-1:0] base; // of the operand, one cycle after its issue
    reg [2:1] mirrors; // one cycle after its issue: the operand's mirror image is meant
    reg [4:1] frictions; // three cycles after its issue: friction components are the coefficients
    wire [OPERAND_WIDTH-1:0] stress_base = bank ? SECOND_BANK[OPERAND_WIDTH-1:0] : {OPERAND_WIDTH{1'b0}};
    wire [OPERAND_WIDTH-1:0] residual_bank
        = (FRICTIONS[product] && field_bank) ? RESIDUAL_BANK[OPERAND_WIDTH-1:0] : {OPERAND_WIDTH{1'b0}};
    reg write; // to the operand memories
    reg [OPERAND_WIDTH-1:0] address;
    reg [CHANNELS*DATA_BITS-1:0] data;

    always @(posedge clock) begin
        restart <= started;
        start_word <= first_word;
        start_slot <= first_slot;
        restart_segment <= starts;
        start_segment <= chosen_segment;
        issue <= run;
        mark <= run && first_issue && MARKS[product];
        rewind <= run && first_issue && REWINDS[product];
        base_1 <= OF_STRESS[product] ? stress_base : BASES[16*product +: OPERAND_WIDTH] + residual_bank;
        base <= base_1;
        mirrors <= {mirrors[1], MIRRORED[product]};
        frictions <= {frictions[3:1], FRICTIONS[product]};
        write <= write_enable;
        address <= write_address;
        data <= write_data;
        if (reset) begin
            restart <= 1'b0;
            restart_segment <= 1'b0;
            issue <= 1'b0;
            mark <= 1'b0;
            rewind <= 1'b0;
            write <= 1'b0;
        end
    end

    // ---- PEs. Of a sum they keep the bits of any result, and one below to round it
    localparam RESULT_BITS = ((LARGEST_SHIFT + DATA_BITS < 48) ? LARGEST_SHIFT + DATA_BITS : 48) - LEAST_SHIFT + 1;
    wire [RESULT_BITS*CHANNELS*PES-1:0] results;
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
            .LEAST_SHIFT      (LEAST_SHIFT),
            .RESULT_BITS      (RESULT_BITS),
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
            .mirrored        (mirrors[2]),
            .friction        (frictions[4]),
            .mu_x            (mu_x),
            .mu_y            (mu_y),
            .write_enable    (write),
            .write_address   (address),
            .write_data      (data),
            .next_carry      (carries[48*CHANNELS*NEXT +: 48*CHANNELS]),
            .carry           (carries[48*CHANNELS*index +: 48*CHANNELS]),
            .result          (results[RESULT_BITS*CHANNELS*index +: RESULT_BITS*CHANNELS]),
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
        .LEAST_SHIFT      (LEAST_SHIFT),
        .LARGEST_SHIFT    (LARGEST_SHIFT),
        .RESULT_BITS      (RESULT_BITS),
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
