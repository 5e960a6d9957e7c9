// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The sum of a frame's |w|, and the largest, as the weights come. From the last of them: 4 cycles.
//
// On a centre line of the grid images of an orbit are the same taxel, which counts once.

`default_nettype none

module sptfra_weight_totals #(
    // 4: weights come by orbits of a folded grid; 1: by taxels
    parameter CHANNELS = 4,
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Bits of |w|, of their sum, and of an orbit's or taxel's number
    parameter DATA_BITS = 27,
    parameter SUM_BITS = 34,
    parameter ROW_WIDTH = 5
) (
    input  wire clock,
    input  wire reset,
    // Weights
    input  wire valid,
    input  wire first, // of a frame
    input  wire last,
    input  wire [ROW_WIDTH-1:0] row,
    input  wire [CHANNELS*DATA_BITS-1:0] weights, // image 0 in the lowest bits
    // Totals
    output wire there, // one cycle; they hold until the next frame's first
    output reg  [SUM_BITS-1:0] total,
    output reg  [DATA_BITS-1:0] largest
);

    if (SUM_BITS < DATA_BITS + 3) begin : gen_check_sum
        sptfra_error_sums_must_have_three_bits_more_than_weights invalid ();
    end

    reg [3:1] valids;
    reg [3:1] firsts;
    reg [4:1] lasts;
    wire [DATA_BITS+1:0] sum_3; // of the images
    wire [DATA_BITS-1:0] largest_3;

    assign there = lasts[4];

    // ---- Stage 4: the totals
    always @(posedge clock) begin
        valids <= {valids[2:1], valid};
        firsts <= {firsts[2:1], first};
        lasts <= {lasts[3:1], last};
        if (valids[3]) begin
            total <= (firsts[3] ? {SUM_BITS{1'b0}} : total) + {{(SUM_BITS-DATA_BITS-2){1'b0}}, sum_3};
            largest <= (firsts[3] || (largest_3 > largest)) ? largest_3 : largest;
        end
        if (reset) begin
            valids <= 3'd0;
            lasts <= 4'd0;
        end
    end

    if (CHANNELS == 4) begin : gen_orbits
        // ---- Stage 1: what counts. Stage 2: two and two. Stage 3: all four
        wire [3:0] counts;
        reg [3:0] counts_1;
        reg [4*DATA_BITS-1:0] weights_1;
        wire [DATA_BITS-1:0] image_1 [0:3];
        wire [DATA_BITS-1:0] own_1 [0:3];
        reg [DATA_BITS:0] left_2;
        reg [DATA_BITS:0] right_2;
        reg [DATA_BITS-1:0] larger_left_2;
        reg [DATA_BITS-1:0] larger_right_2;
        reg [DATA_BITS+1:0] all_3;
        reg [DATA_BITS-1:0] larger_3;
        genvar index;

        sptfra_orbit_images #(
            .COLUMNS   (COLUMNS),
            .ROWS      (ROWS),
            .ROW_WIDTH (ROW_WIDTH)
        ) images (
            .orbit  (row),
            .counts (counts)
        );

        for (index = 0; index < 4; index = index + 1) begin : gen_images
            assign image_1[index] = weights_1[DATA_BITS*index +: DATA_BITS];
            assign own_1[index] = counts_1[index] ? image_1[index] : {DATA_BITS{1'b0}};
        end

        assign sum_3 = all_3;
        assign largest_3 = larger_3;

        always @(posedge clock) begin
            counts_1 <= counts;
            weights_1 <= weights;
            left_2 <= {1'b0, own_1[0]} + {1'b0, own_1[1]};
            right_2 <= {1'b0, own_1[2]} + {1'b0, own_1[3]};
            larger_left_2 <= (image_1[0] > image_1[1]) ? image_1[0] : image_1[1];
            larger_right_2 <= (image_1[2] > image_1[3]) ? image_1[2] : image_1[3];
            all_3 <= {1'b0, left_2} + {1'b0, right_2};
            larger_3 <= (larger_left_2 > larger_right_2) ? larger_left_2 : larger_right_2;
        end
    end else begin : gen_taxels
        reg [3*DATA_BITS-1:0] passing; // in as many stages

        assign sum_3 = {2'b00, passing[2*DATA_BITS +: DATA_BITS]};
        assign largest_3 = passing[2*DATA_BITS +: DATA_BITS];

        always @(posedge clock) begin
            passing <= {passing[2*DATA_BITS-1:0], weights};
        end

        wire _unused = &{1'b0, row};
    end

endmodule

`default_nettype wire
