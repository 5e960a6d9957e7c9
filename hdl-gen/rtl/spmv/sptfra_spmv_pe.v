// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// One SpMV PE: reads its own MCSR ROMs (values, columns, MACs per row), one multiply-accumulate a cycle in each of
// its channels. Four channels take the parity components of the operand: same row, same column, own coefficient.
//
// Issue to result buffer: 7 cycles (ROM, address, operand memory, 3 for the MAC, carry). Initiation interval: 1.
// Kinds of row segments: 0 row, 1 tail of a row begun in the PE before, 2 head of a row that the next PE
// ends, 3 idle. A head is completed by the carry of the next PE, which is there in time by construction.

`default_nettype none

module sptfra_spmv_pe #(
    // Multiply-accumulates a cycle: 1, or 4 parity components
    parameter CHANNELS = 4,
    // Bits of a coefficient, at most 27, and of an operand, at most 35; the accumulator has 48
    parameter COEFFICIENT_BITS = 18,
    parameter DATA_BITS = 27,
    // Elements of a vector: taxels, or orbits of a folded grid
    parameter ELEMENTS = 25,
    // Vectors that a product reads side by side, at most
    parameter VECTORS = 3,
    // Words of the ROMs and of the operand memory
    parameter WORD_DEPTH = 512,
    parameter SEGMENT_DEPTH = 64,
    parameter OPERAND_DEPTH = 200,
    // Orbits along a side of a square grid of which some products are mirrored at the diagonal; 0: none is
    parameter MIRROR_SIDE = 0,
    // Whether friction components take the coefficients' place in some products
    parameter FRICTION = 1,
    // Bits of a result. The lowest one is half of 2^LEAST_SHIFT steps of the sum
    parameter LEAST_SHIFT = 0,
    parameter RESULT_BITS = 49,
    // Prefix of the ROM file names
    parameter ROM_DIR = "",
    // Names of the ROM files: coefficients, columns, row segments
    parameter VALUES_FILE = "",
    parameter COLUMNS_FILE = "",
    parameter MACS_FILE = "",
    // Derived
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter WORD_WIDTH = (WORD_DEPTH > 2) ? $clog2(WORD_DEPTH) : 1,
    parameter OPERAND_WIDTH = (OPERAND_DEPTH > 2) ? $clog2(OPERAND_DEPTH) : 1
) (
    input  wire clock,
    input  wire reset,
    // From the array's control
    input  wire restart, // with the addresses of a program's data
    input  wire [WORD_WIDTH-1:0] start_word,
    input  wire restart_segment, // one cycle before, with
    input  wire [15:0] start_segment,
    input  wire issue,
    input  wire mark,
    input  wire rewind,
    input  wire [OPERAND_WIDTH-1:0] base,
    input  wire mirrored, // one cycle after its issue: the operand's mirror image is meant
    input  wire friction, // three cycles after its issue: a friction component takes the coefficient's place
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // Operand memory, written alike in all PEs
    input  wire write_enable,
    input  wire [OPERAND_WIDTH-1:0] write_address,
    input  wire [CHANNELS*DATA_BITS-1:0] write_data,
    // Row sums
    input  wire [48*CHANNELS-1:0] next_carry, // of the next PE
    output wire [48*CHANNELS-1:0] carry,
    output wire [RESULT_BITS*CHANNELS-1:0] result,
    output reg  pending, // result waits for the collector
    input  wire take
);

    if (OPERAND_DEPTH < VECTORS * ELEMENTS) begin : gen_check_operands
        sptfra_error_the_operand_memory_does_not_hold_its_vectors invalid ();
    end
    if ((MIRROR_SIDE > 0) && (MIRROR_SIDE * MIRROR_SIDE != ELEMENTS)) begin : gen_check_mirror
        sptfra_error_only_a_square_grid_is_mirrored invalid ();
    end

    localparam COLUMN_WIDTH = (VECTORS * ELEMENTS > 2) ? $clog2(VECTORS * ELEMENTS) : 1;
    localparam SEGMENT_WIDTH = (SEGMENT_DEPTH > 2) ? $clog2(SEGMENT_DEPTH) : 1;
    localparam [1:0] ROW = 2'd0, TAIL = 2'd1, HEAD = 2'd2, IDLE = 2'd3;

    // ---- Issue: which MAC of which row segment
    wire [15:0] segment_address;
    wire [15:0] segment;
    wire segment_fetch;
    wire first;
    wire last;
    wire [1:0] kind;

    sptfra_row_sequencer row_sequencer (
        .clock         (clock),
        .restart       (restart_segment),
        .start_address (start_segment),
        .issue         (issue),
        .row_word      (segment),
        .row_address   (segment_address),
        .row_fetch     (segment_fetch),
        .first         (first),
        .last          (last),
        .kind          (kind)
    );

    sptfra_rom #(
        .WIDTH         (16),
        .DEPTH         (SEGMENT_DEPTH),
        .ADDRESS_WIDTH (SEGMENT_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (MACS_FILE)
    ) macs_per_row (
        .clock   (clock),
        .enable  (segment_fetch),
        .address (segment_address[SEGMENT_WIDTH-1:0]),
        .data    (segment)
    );

    reg  [WORD_WIDTH-1:0] next_word;
    reg  [WORD_WIDTH-1:0] marked_word;
    wire [WORD_WIDTH-1:0] word = rewind ? marked_word : next_word;
    wire mac_issue = issue && (kind != IDLE);

    always @(posedge clock) begin
        next_word <= restart ? start_word : mac_issue ? word + 1 : word;
        if (mark) begin
            marked_word <= next_word;
        end
    end

    wire [CHANNELS*COEFFICIENT_BITS-1:0] value;
    wire [COLUMN_WIDTH-1:0] column;

    sptfra_rom #(
        .WIDTH         (CHANNELS * COEFFICIENT_BITS),
        .DEPTH         (WORD_DEPTH),
        .ADDRESS_WIDTH (WORD_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (VALUES_FILE)
    ) values (
        .clock   (clock),
        .enable  (1'b1),
        .address (word),
        .data    (value)
    );

    sptfra_rom #(
        .WIDTH         (COLUMN_WIDTH),
        .DEPTH         (WORD_DEPTH),
        .ADDRESS_WIDTH (WORD_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          (COLUMNS_FILE)
    ) columns (
        .clock   (clock),
        .enable  (1'b1),
        .address (word),
        .data    (column)
    );

    // ---- Operand: the column, or its mirror image. A register stands behind the ROM,
    // and the adder in front of the operand memory: neither memory has more than its own register beside it. Registers
    // that are equal in all PEs are kept, for each PE to have its own at hand
    wire [31:0] column_wide = {{(32-COLUMN_WIDTH){1'b0}}, column};
    wire [ROW_WIDTH-1:0] mirror_image;
    wire [31:0] element; // one cycle after its issue
    reg  [OPERAND_WIDTH-1:0] element_2;
    (* keep = "true" *) reg [OPERAND_WIDTH-1:0] base_2;
    wire [OPERAND_WIDTH-1:0] operand_address = base_2 + element_2;
    wire [CHANNELS*DATA_BITS-1:0] operand;
    reg  [CHANNELS*COEFFICIENT_BITS-1:0] value_2;
    reg  [CHANNELS*COEFFICIENT_BITS-1:0] coefficient;
    (* keep = "true" *) reg [3:2] swaps; // the components that are odd in x only and in y only

    // The orbit on the other side of the diagonal, of each orbit of a square grid
    localparam ORBITS = (MIRROR_SIDE > 0) ? MIRROR_SIDE * MIRROR_SIDE : 1;
    localparam MIRROR_HALF = (MIRROR_SIDE > 1) ? $clog2(MIRROR_SIDE) : 1;

    function [ORBITS*ROW_WIDTH-1:0] images(input integer side);
        integer index;
        integer place;
        reg [31:0] other;
        begin
            images = {(ORBITS*ROW_WIDTH){1'b0}};
            for (index = 0; index < side * side; index = index + 1) begin
                other = (index % side) * side + index / side;
                for (place = 0; place < ROW_WIDTH; place = place + 1) begin
                    images[ROW_WIDTH*index + place] = other[place];
                end
            end
        end
    endfunction

    assign element = mirrored ? {{(32-ROW_WIDTH){1'b0}}, mirror_image} : column_wide;

    if ((MIRROR_SIDE == (1 << MIRROR_HALF)) && (ROW_WIDTH == 2 * MIRROR_HALF)) begin : gen_exchange
        // Row and column change places
        assign mirror_image = {column_wide[MIRROR_HALF-1:0], column_wide[2*MIRROR_HALF-1:MIRROR_HALF]};
    end else if (MIRROR_SIDE > 0) begin : gen_images
        localparam [ORBITS*ROW_WIDTH-1:0] IMAGES = images(MIRROR_SIDE);

        assign mirror_image = IMAGES[ROW_WIDTH*column_wide[ROW_WIDTH-1:0] +: ROW_WIDTH];
    end else begin : gen_no_mirror
        assign mirror_image = {ROW_WIDTH{1'b0}};
    end

    sptfra_ram #(
        .WIDTH         (CHANNELS * DATA_BITS),
        .DEPTH         (OPERAND_DEPTH),
        .ADDRESS_WIDTH (OPERAND_WIDTH)
    ) operands (
        .clock         (clock),
        .write_enable  (write_enable),
        .write_address (write_address),
        .write_data    (write_data),
        .read_enable   (1'b1),
        .read_address  (operand_address),
        .read_data     (operand)
    );

    always @(posedge clock) begin
        swaps <= {swaps[2], mirrored};
        element_2 <= element[OPERAND_WIDTH-1:0];
        base_2 <= base;
        value_2 <= value;
        coefficient <= value_2;
    end

    // ---- Control beside the data: index k holds what belongs to the issue k cycles ago
    reg [3:1] mac_valid;
    reg [3:1] mac_first;
    reg segment_ends_1;
    reg [1:0] kind_1;
    reg [6:2] result_ends;
    reg [6:2] tail_ends;
    reg [6:2] is_head;

    always @(posedge clock) begin
        mac_valid <= {mac_valid[2:1], mac_issue};
        mac_first <= {mac_first[2:1], first};
        segment_ends_1 <= issue && last;
        kind_1 <= kind;
        result_ends <= {result_ends[5:2], segment_ends_1 && ((kind_1 == ROW) || (kind_1 == HEAD))};
        tail_ends <= {tail_ends[5:2], segment_ends_1 && (kind_1 == TAIL)};
        is_head <= {is_head[5:2], kind_1 == HEAD};
        if (reset) begin
            mac_valid <= 3'd0;
            segment_ends_1 <= 1'b0;
            result_ends <= 5'd0;
            tail_ends <= 5'd0;
        end
    end

    // ---- Multiply-accumulate, and two buffers for results
    (* ram_style = "distributed" *) reg [RESULT_BITS*CHANNELS-1:0] buffers [0:1];
    wire [RESULT_BITS*CHANNELS-1:0] row_sums;
    reg write_buffer; // of the next result
    reg read_buffer; // of the first result that waits
    reg [1:0] held; // results
    wire [1:0] kept = held - {1'b0, take};

    assign result = buffers[read_buffer];

    always @(posedge clock) begin
        if (result_ends[6]) begin
            buffers[write_buffer] <= row_sums;
        end
        write_buffer <= write_buffer ^ result_ends[6];
        read_buffer <= read_buffer ^ take;
        held <= kept + {1'b0, result_ends[6]};
        pending <= (kept != 2'd0) || result_ends[6];
        if (reset) begin
            write_buffer <= 1'b0;
            read_buffer <= 1'b0;
            held <= 2'd0;
            pending <= 1'b0;
        end
    end

`ifdef SIMULATION
    // By the schedule there is a buffer for every result
    always @(posedge clock) begin
        if (!reset && result_ends[6] && (kept == 2'd2)) begin
            $fdisplay(32'h80000002, "%m: a result has come while both buffers are taken");
            $fatal(1);
        end
    end
`endif

    genvar channel;
    for (channel = 0; channel < CHANNELS; channel = channel + 1) begin : gen_channels
        // With the diagonal mirror channels 1 and 2 change places
        localparam OTHER = (CHANNELS == 1) ? 0 : (channel == 1) ? 2 : (channel == 2) ? 1 : channel;
        wire [47:0] row_sum;
        wire [48:0] halves = {row_sum, 1'b0};

        sptfra_spmv_lane #(
            .COEFFICIENT_BITS (COEFFICIENT_BITS),
            .DATA_BITS        (DATA_BITS),
            .FRICTION         (FRICTION)
        ) of_channel (
            .clock       (clock),
            .reset       (reset),
            .valid       (mac_valid[3]),
            .first       (mac_first[3]),
            .coefficient (coefficient[COEFFICIENT_BITS*channel +: COEFFICIENT_BITS]),
            .operand     (((MIRROR_SIDE > 0) && swaps[3]) ? operand[DATA_BITS*OTHER +: DATA_BITS]
                : operand[DATA_BITS*channel +: DATA_BITS]),
            .friction    (friction),
            .mu_x        (mu_x),
            .mu_y        (mu_y),
            .tail_ends   (tail_ends[6]),
            .is_head     (is_head[6]),
            .next_carry  (next_carry[48*channel +: 48]),
            .carry       (carry[48*channel +: 48]),
            .row_sum     (row_sum)
        );

        assign row_sums[RESULT_BITS*channel +: RESULT_BITS] = halves[LEAST_SHIFT +: RESULT_BITS];

        wire _unused_sum = &{1'b0, halves};
    end

    wire _unused = &{1'b0, segment_address, column_wide, element, swaps};

endmodule

`default_nettype wire
