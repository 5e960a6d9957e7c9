// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Sequencer of a program's sparse products, in their fixed order and at their fixed times.
//
// A start pulse runs one program: products that follow each other at fixed distances. issued marks the last issue of a
// program. The next start may come in the cycle after that. The tables describe the products: number 0 stands in the
// lowest bits.

`default_nettype none

module sptfra_spmv_sequencer #(
    // Elements of a vector: taxels, or orbits of a folded grid
    parameter ELEMENTS = 25,
    // Words of the PEs' ROMs and operand memories, and of the ROM of write-back slots
    parameter WORD_DEPTH = 512,
    parameter OPERAND_DEPTH = 200,
    parameter SLOT_DEPTH = 200,
    // Products of all programs
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
    // Derived
    parameter WORD_WIDTH = (WORD_DEPTH > 2) ? $clog2(WORD_DEPTH) : 1,
    parameter OPERAND_WIDTH = (OPERAND_DEPTH > 2) ? $clog2(OPERAND_DEPTH) : 1,
    parameter SLOT_WIDTH = (SLOT_DEPTH > 2) ? $clog2(SLOT_DEPTH) : 1
) (
    input  wire clock,
    input  wire reset,
    // Program scheduler
    input  wire [PROGRAMS-1:0] start, // one at a time
    output wire issued,
    // To the PEs
    input  wire bank, // of the stress of the frame whose weights are computed
    input  wire field_bank, // of the residual of the frame whose field is
    output wire restart, // one or two cycles before the first issue of a program, with the addresses of its data
    output reg  [WORD_WIDTH-1:0] start_word,
    output wire restart_segment, // one cycle before restart, with
    output reg  [15:0] start_segment,
    output reg  [SLOT_WIDTH-1:0] start_slot,
    output wire issue, // one MAC a lane and cycle
    output wire mark, // first issue of a matrix that is read again
    output wire rewind, // first issue of reading it again
    output reg  [OPERAND_WIDTH-1:0] base, // of the operand, one cycle after its issue
    output reg  mirrored, // one cycle after its issue: the operand's mirror image is meant
    output wire friction // three cycles after its issue: friction components are the coefficients
);

    if ((PROGRAMS < 1) || (PROGRAMS > 3)) begin : gen_check_programs
        sptfra_error_programs_must_be_1_to_3 invalid ();
    end
    if (!LASTS[PRODUCTS-1]) begin : gen_check_last
        sptfra_error_the_last_product_must_end_its_program invalid ();
    end

    localparam PRODUCT_WIDTH = (PRODUCTS > 2) ? $clog2(PRODUCTS) : 1;
    localparam [1:0] IDLE = 2'd0, WAIT = 2'd1, RUN = 2'd2;
    localparam [COUNT_BITS-1:0] ONE = 1;

    // ---- The program that is started: what is known of its first product, one cycle behind start
    reg [1:0] state;
    reg [PRODUCT_WIDTH-1:0] product;
    reg [COUNT_BITS-1:0] count;
    reg over; // count is 1
    reg first_issue;
    reg [PRODUCT_WIDTH-1:0] chosen;
    reg [WORD_WIDTH-1:0] chosen_word;
    reg [SLOT_WIDTH-1:0] chosen_slot;
    reg [PRODUCT_WIDTH-1:0] first_product;
    reg [COUNT_BITS-1:0] first_wait;
    reg [COUNT_BITS-1:0] first_length;
    reg first_is_last;
    integer number;

    always @(*) begin
        chosen = {PRODUCT_WIDTH{1'b0}};
        chosen_word = {WORD_WIDTH{1'b0}};
        chosen_slot = {SLOT_WIDTH{1'b0}};
        start_segment = 16'd0;
        for (number = 0; number < PROGRAMS; number = number + 1) begin
            if (start[number]) begin
                chosen = FIRSTS[8*number +: PRODUCT_WIDTH];
                chosen_word = START_WORDS[32*number +: WORD_WIDTH];
                chosen_slot = START_SLOTS[32*number +: SLOT_WIDTH];
                start_segment = START_SEGMENTS[16*number +: 16];
            end
        end
    end

    always @(posedge clock) begin
        first_product <= chosen;
        first_wait <= WAITS[COUNT_BITS*chosen +: COUNT_BITS];
        first_length <= LENGTHS[COUNT_BITS*chosen +: COUNT_BITS];
        first_is_last <= LASTS[chosen];
        start_word <= chosen_word;
        start_slot <= chosen_slot;
    end

    // ---- The next product, all looked up before it is known which is wanted
    reg started; // one cycle behind start, with the program's data
    reg program_last;
    wire run_last = (state == RUN) && over;
    wire advance = started || (run_last && !program_last);
    wire [PRODUCT_WIDTH-1:0] following = product + 1;
    wire [PRODUCT_WIDTH-1:0] next_product = started ? first_product : following;
    wire [COUNT_BITS-1:0] next_wait = started ? first_wait : WAITS[COUNT_BITS*following +: COUNT_BITS];
    wire [COUNT_BITS-1:0] next_length = started ? first_length : LENGTHS[COUNT_BITS*following +: COUNT_BITS];
    wire [COUNT_BITS-1:0] own_length = LENGTHS[COUNT_BITS*product +: COUNT_BITS];
    wire next_last = started ? first_is_last : LASTS[following];

    assign restart_segment = (start != {PROGRAMS{1'b0}});
    assign restart = started;
    assign issue = (state == RUN);
    assign issued = run_last && program_last;
    assign mark = issue && first_issue && MARKS[product];
    assign rewind = issue && first_issue && REWINDS[product];

    always @(posedge clock) begin
        started <= (start != {PROGRAMS{1'b0}});
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

    // ---- The operand's first word in the PEs' memories, its mirror image, the coefficients' kind
    localparam [31:0] SECOND_BANK = ELEMENTS;
    reg [3:1] frictions;

    assign friction = frictions[3];

    always @(posedge clock) begin
        if (OF_STRESS[product]) begin
            base <= bank ? SECOND_BANK[OPERAND_WIDTH-1:0] : {OPERAND_WIDTH{1'b0}};
        end else begin
            base <= BASES[16*product +: OPERAND_WIDTH]
                + ((FRICTIONS[product] && field_bank) ? RESIDUAL_BANK[OPERAND_WIDTH-1:0] : {OPERAND_WIDTH{1'b0}});
        end
        mirrored <= MIRRORED[product];
        frictions <= {frictions[2:1], FRICTIONS[product]};
    end

endmodule

`default_nettype wire
