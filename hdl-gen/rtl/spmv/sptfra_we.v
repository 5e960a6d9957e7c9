// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// We: weights |w| = max(-y, 0) (Eq. 9) from y = C33inv b; of a folded grid also what pulls, y+ = max(y, 0).
//
// Taxels to operand memories: 1 cycle. Folded again into parity components: 4 cycles for |w|, 5 for y+. The array adds
// one.

`default_nettype none

module sptfra_we #(
    // 4: parity components; 1: taxels
    parameter CHANNELS = 4,
    // Elements of a vector: taxels, or orbits of a folded grid
    parameter ELEMENTS = 25,
    // Bits of a value
    parameter DATA_BITS = 27,
    // Bits dropped when weights are folded
    parameter FOLD_SHIFT = 2,
    // Words of the operand memories, and where |w| stands there; y+ stands ELEMENTS before it
    parameter OPERAND_DEPTH = 200,
    parameter WEIGHT_BASE = 100,
    // Derived
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter OPERAND_WIDTH = (OPERAND_DEPTH > 2) ? $clog2(OPERAND_DEPTH) : 1
) (
    input  wire clock,
    input  wire reset,
    // Taxels
    input  wire taxel_y,
    input  wire [ROW_WIDTH-1:0] taxel_row,
    input  wire [CHANNELS*DATA_BITS-1:0] taxels, // y, image 0 in the lowest bits
    // Weights of the taxels, to the field and the contact counter
    output wire weights_valid,
    output wire [ROW_WIDTH-1:0] weights_row,
    output wire [CHANNELS*DATA_BITS-1:0] weights,
    // Operand memories
    output wire write_next, // write_valid of the next cycle
    output reg  write_valid,
    output reg  [OPERAND_WIDTH-1:0] write_address,
    output reg  [CHANNELS*DATA_BITS-1:0] write_data // component 0 in the lowest bits
);

    localparam LATENCY = (CHANNELS == 4) ? 5 : 1; // from taxels to the last write of them, which simulations check
    localparam [31:0] BASE = WEIGHT_BASE;
    localparam [31:0] LENGTH = ELEMENTS;
    localparam signed [DATA_BITS-1:0] ZERO = 0;

    if (CHANNELS == 4) begin : gen_folded
        // ---- Stage 1: part. Stages 2 and 3: fold
        reg [3:1] valid;
        reg [ROW_WIDTH-1:0] orbit_1;
        reg [ROW_WIDTH-1:0] orbit_2;
        reg [ROW_WIDTH-1:0] orbit_3;
        wire [4*DATA_BITS-1:0] press;
        wire [4*DATA_BITS-1:0] pull;
        wire [4*DATA_BITS+7:0] press_sums;
        wire [4*DATA_BITS+7:0] pull_sums;
        genvar index;

        always @(posedge clock) begin
            valid <= {valid[2:1], taxel_y};
            {orbit_3, orbit_2, orbit_1} <= {orbit_2, orbit_1, taxel_row};
            if (reset) begin
                valid <= 3'd0;
            end
        end

        for (index = 0; index < 4; index = index + 1) begin : gen_images
            wire signed [DATA_BITS-1:0] y = taxels[DATA_BITS*index +: DATA_BITS];
            reg signed [DATA_BITS-1:0] pressing;
            reg signed [DATA_BITS-1:0] pulling;

            always @(posedge clock) begin
                pressing <= y[DATA_BITS-1] ? -y : ZERO;
                pulling <= y[DATA_BITS-1] ? ZERO : y;
            end

            assign press[DATA_BITS*index +: DATA_BITS] = pressing;
            assign pull[DATA_BITS*index +: DATA_BITS] = pulling;
        end

        sptfra_butterfly #(
            .WIDTH (DATA_BITS)
        ) fold_press (
            .clock  (clock),
            .enable (1'b1),
            .values (press),
            .sums   (press_sums)
        );

        sptfra_butterfly #(
            .WIDTH (DATA_BITS)
        ) fold_pull (
            .clock  (clock),
            .enable (1'b1),
            .values (pull),
            .sums   (pull_sums)
        );

        assign weights_valid = valid[1];
        assign weights_row = orbit_1;
        assign weights = press;

        // ---- Stages 4 and 5: round, write one after the other. The next result is two cycles behind, or more
        localparam [DATA_BITS+1:0] HALF = (FOLD_SHIFT > 0) ? 1 << (FOLD_SHIFT - 1) : 0;
        reg pull_waits;
        reg pull_written;
        reg [4*DATA_BITS-1:0] pull_held;
        wire [4*DATA_BITS-1:0] press_rounded;
        wire [4*DATA_BITS-1:0] pull_rounded;
        wire [31:0] orbit_wide = {{(32-ROW_WIDTH){1'b0}}, orbit_3};

        for (index = 0; index < 4; index = index + 1) begin : gen_components
            wire [DATA_BITS+1:0] press_half = press_sums[(DATA_BITS+2)*index +: DATA_BITS+2] + HALF;
            wire [DATA_BITS+1:0] pull_half = pull_sums[(DATA_BITS+2)*index +: DATA_BITS+2] + HALF;

            assign press_rounded[DATA_BITS*index +: DATA_BITS] = press_half[FOLD_SHIFT +: DATA_BITS];
            assign pull_rounded[DATA_BITS*index +: DATA_BITS] = pull_half[FOLD_SHIFT +: DATA_BITS];
            wire _unused = &{1'b0, press_half, pull_half};
        end

        assign write_next = valid[3] || pull_waits;

        always @(posedge clock) begin
            write_valid <= write_next;
            pull_waits <= valid[3];
            pull_written <= pull_waits;
            if (valid[3]) begin
                pull_held <= pull_rounded;
                write_address <= BASE[OPERAND_WIDTH-1:0] + orbit_wide[OPERAND_WIDTH-1:0];
                write_data <= press_rounded;
            end else begin
                write_address <= write_address - LENGTH[OPERAND_WIDTH-1:0]; // y+ stands before |w|
                write_data <= pull_held;
            end
            if (reset) begin
                write_valid <= 1'b0;
                pull_waits <= 1'b0;
                pull_written <= 1'b0;
            end
        end

        sptfra_check_latency #(
            .CYCLES    (LATENCY),
            .PIPELINED (1)
        ) check_latency (
            .clock (clock),
            .reset (reset),
            .start (taxel_y),
            .done  (pull_written)
        );

        wire _unused = &{1'b0, orbit_wide};
    end else begin : gen_taxels
        wire signed [DATA_BITS-1:0] y = taxels[DATA_BITS-1:0];
        wire [31:0] row_wide = {{(32-ROW_WIDTH){1'b0}}, taxel_row};

        reg [ROW_WIDTH-1:0] row;

        assign weights_valid = write_valid;
        assign weights_row = row;
        assign weights = write_data;
        assign write_next = taxel_y;

        always @(posedge clock) begin
            write_valid <= taxel_y;
            row <= taxel_row;
            write_address <= BASE[OPERAND_WIDTH-1:0] + row_wide[OPERAND_WIDTH-1:0];
            write_data <= y[DATA_BITS-1] ? -y : ZERO;
            if (reset) begin
                write_valid <= 1'b0;
            end
        end

        sptfra_check_latency #(
            .CYCLES    (LATENCY),
            .PIPELINED (1)
        ) check_latency (
            .clock (clock),
            .reset (reset),
            .start (taxel_y),
            .done  (write_valid)
        );

        wire _unused = &{1'b0, row_wide};
    end

endmodule

`default_nettype wire
