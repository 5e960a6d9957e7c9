// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The field memory of a wide stream, and the forces as they leave it: f = A+ r + [mu_x |w|, mu_y |w|, -|w|] of every
// taxel of a folded grid, WORDS components a cycle in the order of the output: x, y, z, taxel by taxel.
//
// Up to four components are those of two neighbours at most, of which each has a copy of the memory. Two frames of
// A_p r, four of |w|, which is there long before it is needed. From step to forces: 6 cycles.

`default_nettype none

module sptfra_field_wide #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Components a cycle: 2 or 4
    parameter WORDS = 4,
    // Bits of A_p r and of |w|: up to 27, or up to 35 by two multipliers a component
    parameter DATA_BITS = 27,
    // Left shifts of A_p r, and of |w| times a friction component, to the step of the force
    parameter FORCE_SHIFT = 0,
    parameter SHARE_SHIFT = 0,
    // Derived
    parameter QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (QUADS > 8) ? $clog2(QUADS) : 3
) (
    input  wire clock,
    input  wire reset,
    // Weights, from We
    input  wire weights_valid,
    input  wire [ROW_WIDTH-1:0] weights_row,
    input  wire [4*DATA_BITS-1:0] weights,
    input  wire coefficients_complete, // the weights' bank changes
    // A_p r, unfolded
    input  wire [2:0] taxel_force,
    input  wire [ROW_WIDTH-1:0] taxel_row,
    input  wire [4*DATA_BITS-1:0] taxels,
    input  wire taxel_last,
    output reg  complete, // one cycle: a frame's field is there
    // To the output: after rewind, the first components; after each step, the next ones
    input  wire enable,
    input  wire rewind,
    input  wire step,
    input  wire release_frame, // the banks read are free again
    input  wire signed [17:0] mu_x, // of the frame that is read, held
    input  wire signed [17:0] mu_y,
    output wire [64*WORDS-1:0] force_value // the first in the lowest bits
);

    generate
        if ((COLUMNS < 2) || (ROWS < 2) || (COLUMNS > 64) || (ROWS > 64)) begin : gen_check_grid
            sptfra_error_columns_and_rows_must_be_2_to_64 invalid ();
        end
        if ((WORDS != 2) && (WORDS != 4)) begin : gen_check_words
            sptfra_error_words_must_be_2_or_4 invalid ();
        end
        if (DATA_BITS > 35) begin : gen_check_data
            sptfra_error_data_bits_must_be_up_to_35 invalid ();
        end
    endgenerate

    localparam FACTOR_BITS = (DATA_BITS > 27) ? 35 : 27;
    localparam PRODUCT_BITS = FACTOR_BITS + 18;
    localparam signed [17:0] ONE = 18'sd65536; // friction has 16 fraction bits

    // ---- Banks
    wire is_force = (taxel_force != 3'd0);
    reg fill_bank;
    reg [1:0] weight_fill_bank;
    reg read_bank;
    reg [1:0] weight_read_bank;

    always @(posedge clock) begin
        complete <= is_force && taxel_last;
        if (is_force && taxel_last) begin
            fill_bank <= !fill_bank;
        end
        if (coefficients_complete) begin
            weight_fill_bank <= weight_fill_bank + 2'd1;
        end
        if (release_frame) begin
            read_bank <= !read_bank;
            weight_read_bank <= weight_read_bank + 2'd1;
        end
        if (reset) begin
            complete <= 1'b0;
            fill_bank <= 1'b0;
            weight_fill_bank <= 2'd0;
            read_bank <= 1'b0;
            weight_read_bank <= 2'd0;
        end
    end

    // ---- Which components: the first of them, and by how many taxels a beat moves on
    reg [1:0] p; // component of the first: 0 x, 1 y, 2 z
    reg [1:0] p_1;
    reg [1:0] p_2;
    reg [1:0] p_3;
    reg [1:0] p_4;
    wire [1:0] next_p = (WORDS == 4) ? (p[1] ? 2'd0 : p + 2'd1) : ((p == 2'd0) ? 2'd2 : p - 2'd1);
    wire [1:0] moves = (WORDS == 4) ? (p[1] ? 2'd2 : 2'd1) : ((p == 2'd0) ? 2'd0 : 2'd1);

    always @(posedge clock) begin
        if (enable) begin
            p_1 <= p;
            p_2 <= p_1;
            p_3 <= p_2;
            p_4 <= p_3;
        end
        if (step) begin
            p <= next_p;
        end
        if (rewind) begin
            p <= 2'd0;
        end
    end

    // ---- Stages 1 to 4: the taxel of the first component, and the one after it
    wire [3*DATA_BITS-1:0] forces_4 [0:1];
    wire [DATA_BITS-1:0] weight_4 [0:1];
    genvar index;
    genvar bit_index;

    generate
        for (index = 0; index < 2; index = index + 1) begin : gen_taxels
            wire [ROW_WIDTH-1:0] quad;
            wire [1:0] member;

            sptfra_taxel_walk #(
                .COLUMNS (COLUMNS),
                .ROWS    (ROWS),
                .FIRST   (index)
            ) walk (
                .clock  (clock),
                .rewind (rewind),
                .step   (step),
                .taxels (moves),
                .quad   (quad),
                .member (member)
            );

            sptfra_field_port #(
                .QUADS     (QUADS),
                .DATA_BITS (DATA_BITS)
            ) memory (
                .clock            (clock),
                .weights_valid    (weights_valid),
                .weights_bank     (weight_fill_bank),
                .weights_row      (weights_row),
                .weights          (weights),
                .taxel_force      (taxel_force),
                .taxel_bank       (fill_bank),
                .taxel_row        (taxel_row),
                .taxels           (taxels),
                .enable           (enable),
                .read_bank        (read_bank),
                .weight_read_bank (weight_read_bank),
                .quad             (quad),
                .member           (member),
                .forces           (forces_4[index]),
                .weight           (weight_4[index])
            );
        end
    endgenerate

    // ---- Stage 5: each component's own; stage 6: the weight's share of it, and both; stage 7: the force
    generate
        for (index = 0; index < WORDS; index = index + 1) begin : gen_words
            localparam [2:0] PLACE = index;
            wire [2:0] place_4 = {1'b0, p_4} + PLACE;
            wire second_4 = (place_4 > 3'd2); // of the taxel after the first
            wire [2:0] component_4 = second_4 ? place_4 - 3'd3 : place_4;
            wire [3*DATA_BITS-1:0] of_taxel_4 = second_4 ? forces_4[1] : forces_4[0];
            reg signed [17:0] share_5;
            reg signed [DATA_BITS-1:0] weight_5;
            reg signed [DATA_BITS-1:0] force_5;
            reg signed [DATA_BITS-1:0] force_6;
            reg signed [63:0] force_7;
            wire signed [FACTOR_BITS-1:0] weight_wide;
            wire signed [PRODUCT_BITS-1:0] product_low_6; // the product is their sum
            wire signed [PRODUCT_BITS-1:0] product_high_6;
            wire signed [63:0] force_wide = {{(64-DATA_BITS){force_6[DATA_BITS-1]}}, force_6};
            wire signed [63:0] product_low = {{(64-PRODUCT_BITS){product_low_6[PRODUCT_BITS-1]}}, product_low_6};
            wire signed [63:0] product_high = {{(64-PRODUCT_BITS){product_high_6[PRODUCT_BITS-1]}}, product_high_6};

            for (bit_index = 0; bit_index < FACTOR_BITS; bit_index = bit_index + 1) begin : gen_weight
                assign weight_wide[bit_index] = weight_5[(bit_index < DATA_BITS) ? bit_index : DATA_BITS - 1];
            end

            assign force_value[64*index +: 64] = force_7;

            sptfra_multiply #(
                .WIDE (DATA_BITS > 27)
            ) multiplier (
                .clock       (clock),
                .enable      (enable),
                .coefficient (share_5),
                .data        (weight_wide),
                .low         (product_low_6),
                .high        (product_high_6)
            );

            always @(posedge clock) begin
                if (enable) begin
                    case (component_4[1:0])
                        2'd0: share_5 <= mu_x;
                        2'd1: share_5 <= mu_y;
                        default: share_5 <= -ONE;
                    endcase
                    weight_5 <= second_4 ? weight_4[1] : weight_4[0];
                    case (component_4[1:0])
                        2'd0: force_5 <= of_taxel_4[DATA_BITS*0 +: DATA_BITS];
                        2'd1: force_5 <= of_taxel_4[DATA_BITS*1 +: DATA_BITS];
                        default: force_5 <= of_taxel_4[DATA_BITS*2 +: DATA_BITS];
                    endcase
                    force_6 <= force_5;
                    force_7 <= (force_wide <<< FORCE_SHIFT) + (product_low <<< SHARE_SHIFT)
                        + (product_high <<< SHARE_SHIFT);
                end
            end

            wire _unused = &{1'b0, component_4[2]};
        end
    endgenerate

endmodule

`default_nettype wire
