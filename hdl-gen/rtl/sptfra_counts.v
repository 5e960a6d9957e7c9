// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Counts to stress: times the taxel's gain, rounded, plus its offset, clipped to the full scale.
//
// Count to stress: 4 cycles, one a cycle. Names end in the number of cycles since the count came in.

`default_nettype none

module sptfra_counts #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Whether each taxel has a gain and an offset of its own, in ROMs; else all have GAIN and none
    parameter PER_TAXEL = 0,
    parameter signed [17:0] GAIN = 18'sd65536,
    parameter OFFSET_BITS = 27,
    // Bits dropped of the product
    parameter SHIFT = 16,
    // Full scale, less what the rounding of gains takes from it, and what a larger stress becomes
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = ""
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // Counts
    input  wire next_taxel, // this count is of a taxel, the next one of the taxel after it
    input  wire frame_ends, // the next one is of the first taxel
    input  wire signed [26:0] number,
    input  wire number_saturated,
    input  wire number_not_finite,
    // Stress
    output reg  signed [26:0] stress,
    output reg  saturated,
    output wire not_finite
);

    localparam TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1;
    localparam signed [47:0] HALF = (48'sd1 <<< SHIFT) >>> 1;

    // ---- The taxel's gain and offset
    wire [17:0] gain_1;
    wire [OFFSET_BITS-1:0] offset_1;

    generate
        if (PER_TAXEL != 0) begin : gen_per_taxel
            reg [TAXEL_WIDTH-1:0] taxel_0;
            reg [TAXEL_WIDTH-1:0] taxel_1;
            wire [TAXEL_WIDTH-1:0] address = advance ? taxel_0 : taxel_1; // a beat that waits keeps its gain

            sptfra_rom #(
                .WIDTH         (18),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_gains.mem"})
            ) gains (
                .clock   (clock),
                .enable  (1'b1),
                .address (address),
                .data    (gain_1)
            );

            sptfra_rom #(
                .WIDTH         (OFFSET_BITS),
                .DEPTH         (TAXELS),
                .ADDRESS_WIDTH (TAXEL_WIDTH),
                .ROM_DIR       (ROM_DIR),
                .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_offsets.mem"})
            ) offsets (
                .clock   (clock),
                .enable  (1'b1),
                .address (address),
                .data    (offset_1)
            );

            always @(posedge clock) begin
                if (advance) begin
                    taxel_1 <= taxel_0;
                    if (next_taxel) begin
                        taxel_0 <= taxel_0 + 1;
                    end
                    if (frame_ends) begin
                        taxel_0 <= {TAXEL_WIDTH{1'b0}};
                    end
                end
                if (reset) begin
                    taxel_0 <= {TAXEL_WIDTH{1'b0}};
                end
            end
        end else begin : gen_shared
            assign gain_1 = GAIN;
            assign offset_1 = {OFFSET_BITS{1'b0}};
            wire _unused = &{1'b0, reset, next_taxel, frame_ends};
        end
    endgenerate

    // ---- Product, sum, clipping
    reg signed [26:0] number_1;
    wire signed [44:0] product_low_2; // the product is their sum
    wire signed [44:0] product_high_2;
    reg signed [47:0] offset_2;
    reg signed [47:0] sum_3;
    reg [3:1] number_saturated_to;
    reg [4:1] not_finite_to;
    wire signed [47:0] product_half = {{3{product_low_2[44]}}, product_low_2}
        + {{3{product_high_2[44]}}, product_high_2} + HALF;
    wire above = (sum_3 >= FULL_SCALE);
    wire below = (sum_3 <= -FULL_SCALE);

    assign not_finite = not_finite_to[4];

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (advance),
        .coefficient (gain_1),
        .data        (number_1),
        .low         (product_low_2),
        .high        (product_high_2)
    );

    always @(posedge clock) begin
        if (advance) begin
            number_1 <= number;
            offset_2 <= {{(48-OFFSET_BITS){offset_1[OFFSET_BITS-1]}}, offset_1};
            sum_3 <= (product_half >>> SHIFT) + offset_2;
            stress <= above ? STRESS_BOUND : below ? -STRESS_BOUND : sum_3[26:0];
            saturated <= above || below || number_saturated_to[3];
            number_saturated_to <= {number_saturated_to[2:1], number_saturated};
            not_finite_to <= {not_finite_to[3:1], number_not_finite};
        end
    end

endmodule

`default_nettype wire
