// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Field memory of a folded grid, with the forces f = A+ r + [mu_x |w|, mu_y |w|, -|w|] of every taxel at its output.
// WORDS components leave it a cycle in the order of the output: x, y, z, taxel by taxel.
//
// It is written an orbit at a time. It holds A_p r of two frames, and |w| of four: |w| comes long before its use. Up to
// four components belong to two neighbours at most; each has a copy of the memory. From step to forces: 6 cycles,
// with several words 7.

`default_nettype none

module sptfra_field #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Components a cycle: 1, 2 or 4
    parameter WORDS = 1,
    // Bits of A_p r and of |w|: up to 27, or up to 35 by two multipliers a component
    parameter DATA_BITS = 27,
    // Left shifts of A_p r, and of |w| times a friction component, to the step of the force
    parameter FORCE_SHIFT = 0,
    parameter SHARE_SHIFT = 0,
    // Derived
    parameter ORBITS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ORBITS > 8) ? $clog2(ORBITS) : 3
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

    localparam FACTOR_BITS = (DATA_BITS > 27) ? 35 : 27;
    localparam PRODUCT_BITS = FACTOR_BITS + 18;
    localparam TAXELS = (WORDS > 1) ? 2 : 1; // read in a cycle
    localparam FORCES = (WORDS > 1) ? 3 : 1; // components of a taxel that are read in a cycle
    localparam BANK = (3 / FORCES) * ORBITS; // one memory holds the components that do not leave together
    localparam [31:0] LENGTH = (FORCES == 1) ? ORBITS : 0; // from component to component
    localparam [31:0] SECOND_BANK = BANK;
    localparam FORCE_WIDTH = $clog2(2 * BANK);
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
    // Two words are two components on, one and four are one
    wire [1:0] next_p = (WORDS == 2) ? ((p == 2'd0) ? 2'd2 : p - 2'd1) : (p[1] ? 2'd0 : p + 2'd1);
    wire [1:0] moves = (WORDS == 4) ? (p[1] ? 2'd2 : 2'd1) : {1'b0, (WORDS == 2) ? (p != 2'd0) : p[1]};

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

    // ---- Stages 1 to 4: the taxel of the first component, and the one after it. A memory for each image of the orbits
    wire [31:0] write_part = taxel_force[0] ? 0 : taxel_force[1] ? LENGTH : 2 * LENGTH;
    wire [31:0] write_row = {{(32-ROW_WIDTH){1'b0}}, taxel_row};
    wire [31:0] write_place = (fill_bank ? SECOND_BANK : 0) + write_part + write_row;
    wire [31:0] read_part = (p == 2'd0) ? 0 : (p == 2'd1) ? LENGTH : 2 * LENGTH;
    wire [31:0] read_base = (read_bank ? SECOND_BANK : 0) + read_part;
    wire [FORCES*DATA_BITS-1:0] forces_4 [0:TAXELS-1]; // x in the lowest bits
    wire [DATA_BITS-1:0] weight_4 [0:TAXELS-1];
    genvar taxel;
    genvar index;
    genvar p_index;
    for (taxel = 0; taxel < TAXELS; taxel = taxel + 1) begin : gen_taxels
        wire [ROW_WIDTH-1:0] orbit;
        wire [1:0] image;
        wire [31:0] read_place = read_base + {{(32-ROW_WIDTH){1'b0}}, orbit};
        reg [FORCE_WIDTH-1:0] force_address_1;
        reg [ROW_WIDTH+1:0] weight_address_1;
        reg [1:0] image_1;
        reg [1:0] image_2;
        reg [1:0] image_3;
        wire [4*DATA_BITS-1:0] weights_2;
        reg [4*DATA_BITS-1:0] weights_3;
        reg [DATA_BITS-1:0] chosen_4;

        assign weight_4[taxel] = chosen_4;

        sptfra_taxel_walk #(
            .COLUMNS (COLUMNS),
            .ROWS    (ROWS),
            .FIRST   (taxel)
        ) walk (
            .clock  (clock),
            .rewind (rewind),
            .step   (step),
            .taxels (moves),
            .orbit  (orbit),
            .image  (image)
        );

        always @(posedge clock) begin
            if (enable) begin
                force_address_1 <= read_place[FORCE_WIDTH-1:0];
                weight_address_1 <= {weight_read_bank, orbit};
                image_1 <= image;
                image_2 <= image_1;
                image_3 <= image_2;
                weights_3 <= weights_2;
                chosen_4 <= weights_3[DATA_BITS*image_3 +: DATA_BITS];
            end
        end

        for (index = 0; index < 4; index = index + 1) begin : gen_weights
            sptfra_ram #(
                .WIDTH         (DATA_BITS),
                .DEPTH         (4 << ROW_WIDTH),
                .ADDRESS_WIDTH (ROW_WIDTH + 2)
            ) orbit_weights (
                .clock         (clock),
                .write_enable  (weights_valid),
                .write_address ({weight_fill_bank, weights_row}),
                .write_data    (weights[DATA_BITS*index +: DATA_BITS]),
                .read_enable   (enable),
                .read_address  (weight_address_1),
                .read_data     (weights_2[DATA_BITS*index +: DATA_BITS])
            );
        end

        for (p_index = 0; p_index < FORCES; p_index = p_index + 1) begin : gen_forces
            wire [4*DATA_BITS-1:0] forces_2;
            reg [4*DATA_BITS-1:0] forces_3;
            reg [DATA_BITS-1:0] force_4;

            assign forces_4[taxel][DATA_BITS*p_index +: DATA_BITS] = force_4;

            always @(posedge clock) begin
                if (enable) begin
                    forces_3 <= forces_2;
                    force_4 <= forces_3[DATA_BITS*image_3 +: DATA_BITS];
                end
            end

            for (index = 0; index < 4; index = index + 1) begin : gen_images
                sptfra_ram #(
                    .WIDTH         (DATA_BITS),
                    .DEPTH         (2 * BANK),
                    .ADDRESS_WIDTH (FORCE_WIDTH)
                ) orbit_forces (
                    .clock         (clock),
                    .write_enable  ((FORCES == 1) ? is_force : taxel_force[p_index]),
                    .write_address (write_place[FORCE_WIDTH-1:0]),
                    .write_data    (taxels[DATA_BITS*index +: DATA_BITS]),
                    .read_enable   (enable),
                    .read_address  (force_address_1),
                    .read_data     (forces_2[DATA_BITS*index +: DATA_BITS])
                );
            end
        end

        wire _unused = &{1'b0, read_place};
    end

    // ---- Index a: chosen, which several words take a stage for; b: the weight's share of it, and both; c: the force
    genvar word;
    genvar place;
    for (word = 0; word < WORDS; word = word + 1) begin : gen_words
        wire [1:0] component; // a cycle before a
        wire signed [DATA_BITS-1:0] weight_a;
        wire signed [DATA_BITS-1:0] force_a;
        reg signed [17:0] share_a;
        reg signed [DATA_BITS-1:0] force_b;
        reg signed [63:0] force_c;
        wire signed [FACTOR_BITS-1:0] weight_wide;
        wire signed [PRODUCT_BITS-1:0] product_b;
        wire signed [63:0] force_wide = {{(64-DATA_BITS){force_b[DATA_BITS-1]}}, force_b};
        wire signed [63:0] product = {{(64-PRODUCT_BITS){product_b[PRODUCT_BITS-1]}}, product_b};

        assign force_value[64*word +: 64] = force_c;

        if (WORDS == 1) begin : gen_only
            assign component = p_3;
            assign weight_a = weight_4[0];
            assign force_a = forces_4[0];

            wire _unused = &{1'b0, p_4};
        end else begin : gen_choice
            localparam [2:0] PLACE = word;
            wire [2:0] place_4 = {1'b0, p_4} + PLACE;
            wire second_4 = (place_4 > 3'd2); // of the taxel after the first
            wire [2:0] component_4 = second_4 ? place_4 - 3'd3 : place_4;
            wire [3*DATA_BITS-1:0] of_taxel_4 = second_4 ? forces_4[TAXELS-1] : forces_4[0];
            reg signed [DATA_BITS-1:0] weight_5;
            reg signed [DATA_BITS-1:0] force_5;

            assign component = component_4[1:0];
            assign weight_a = weight_5;
            assign force_a = force_5;

            always @(posedge clock) begin
                if (enable) begin
                    weight_5 <= second_4 ? weight_4[TAXELS-1] : weight_4[0];
                    case (component)
                        2'd0: force_5 <= of_taxel_4[DATA_BITS*0 +: DATA_BITS];
                        2'd1: force_5 <= of_taxel_4[DATA_BITS*1 +: DATA_BITS];
                        default: force_5 <= of_taxel_4[DATA_BITS*2 +: DATA_BITS];
                    endcase
                end
            end

            wire _unused = &{1'b0, component_4[2]};
        end

        for (place = 0; place < FACTOR_BITS; place = place + 1) begin : gen_weight
            assign weight_wide[place] = weight_a[(place < DATA_BITS) ? place : DATA_BITS - 1];
        end

        sptfra_multiply #(
            .WIDE (DATA_BITS > 27)
        ) multiplier (
            .clock       (clock),
            .enable      (enable),
            .coefficient (share_a),
            .data        (weight_wide),
            .product     (product_b)
        );

        always @(posedge clock) begin
            if (enable) begin
                case (component)
                    2'd0: share_a <= mu_x;
                    2'd1: share_a <= mu_y;
                    default: share_a <= -ONE;
                endcase
                force_b <= force_a;
                force_c <= (force_wide <<< FORCE_SHIFT) + (product <<< SHARE_SHIFT);
            end
        end
    end

    wire _unused = &{1'b0, write_place};

endmodule

`default_nettype wire
