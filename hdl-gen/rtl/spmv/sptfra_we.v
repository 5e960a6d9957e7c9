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
        // ---- Stage 1: |w|, and a cycle later y+. Stages 2 and 3: fold. The next result is two cycles behind, or more
        reg [4:1] valid; // of |w|
        reg [ROW_WIDTH-1:0] orbit_1;
        reg [ROW_WIDTH-1:0] orbit_2;
        reg [ROW_WIDTH-1:0] orbit_3;
        wire [4*DATA_BITS-1:0] parts;
        wire [4*DATA_BITS+7:0] sums;
        genvar index;

        always @(posedge clock) begin
            valid <= {valid[3:1], taxel_y};
            {orbit_3, orbit_2, orbit_1} <= {orbit_2, orbit_1, taxel_row};
            if (reset) begin
                valid <= 4'd0;
            end
        end

        for (index = 0; index < 4; index = index + 1) begin : gen_images
            wire signed [DATA_BITS-1:0] y = taxels[DATA_BITS*index +: DATA_BITS];
            reg signed [DATA_BITS-1:0] part;
            reg signed [DATA_BITS-1:0] pull;

            always @(posedge clock) begin
                part <= pull;
                if (taxel_y) begin
                    part <= y[DATA_BITS-1] ? -y : ZERO;
                    pull <= y[DATA_BITS-1] ? ZERO : y;
                end
            end

            assign parts[DATA_BITS*index +: DATA_BITS] = part;
        end

        sptfra_butterfly #(
            .WIDTH (DATA_BITS)
        ) fold (
            .clock  (clock),
            .enable (1'b1),
            .values (parts),
            .sums   (sums)
        );

        assign weights_valid = valid[1];
        assign weights_row = orbit_1;
        assign weights = parts;

        // ---- Stages 4 and 5: round, write one after the other
        localparam [DATA_BITS+1:0] HALF = (FOLD_SHIFT > 0) ? 1 << (FOLD_SHIFT - 1) : 0;
        wire [4*DATA_BITS-1:0] rounded;
        wire [31:0] orbit_wide = {{(32-ROW_WIDTH){1'b0}}, orbit_3};

        for (index = 0; index < 4; index = index + 1) begin : gen_components
            wire [DATA_BITS+1:0] sum = sums[(DATA_BITS+2)*index +: DATA_BITS+2] + HALF;

            assign rounded[DATA_BITS*index +: DATA_BITS] = sum[FOLD_SHIFT +: DATA_BITS];
            wire _unused = &{1'b0, sum};
        end

        assign write_next = valid[3] || valid[4];

        always @(posedge clock) begin
            write_valid <= write_next;
            write_data <= rounded;
            // y+ stands before |w|
            write_address <= valid[3] ? BASE[OPERAND_WIDTH-1:0] + orbit_wide[OPERAND_WIDTH-1:0]
                : write_address - LENGTH[OPERAND_WIDTH-1:0];
            if (reset) begin
                write_valid <= 1'b0;
            end
        end

        sptfra_check_latency #(
            .CYCLES    (LATENCY - 1),
            .PIPELINED (1)
        ) check_latency (
            .clock (clock),
            .reset (reset),
            .start (taxel_y || valid[1]),
            .done  (write_valid)
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
