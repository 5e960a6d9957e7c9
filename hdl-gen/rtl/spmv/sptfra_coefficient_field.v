// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The field memory where taxels are not folded, and the forces as they leave it: f_p = g_p0 + mu_x g_p1 + mu_y g_p2.
//
// Two frames of the nine coefficient vectors, taxel by taxel, component after component, in as many memories as a beat
// has words. From step to forces: 6 cycles.

`default_nettype none

module sptfra_coefficient_field #(
    // Taxels
    parameter TAXELS = 100,
    // Bits of g
    parameter DATA_BITS = 27,
    // Components a cycle: 1, 2 or 4
    parameter WORDS = 1,
    // Derived
    parameter COMPONENT_WIDTH = $clog2(3 * TAXELS)
) (
    input  wire clock,
    input  wire reset,
    // From Co: g_pq of component 3 i + p - 1
    input  wire [2:0] g_valid, // of q
    input  wire [COMPONENT_WIDTH-1:0] g_component,
    input  wire signed [DATA_BITS-1:0] g,
    input  wire g_last, // one cycle: all of a frame are there
    output wire complete, // one cycle: a frame's field is there, before its friction is known
    // To the output: after rewind, the first components; after each step, the next ones
    input  wire enable,
    input  wire rewind,
    input  wire step,
    input  wire release_frame, // the bank read is free again
    input  wire signed [17:0] mu_x, // of the frame that is read, held
    input  wire signed [17:0] mu_y,
    output wire [64*WORDS-1:0] force_value // the first in the lowest bits
);

    localparam WORD_WIDTH = $clog2(WORDS);
    localparam COMPONENTS = (3 * TAXELS + WORDS - 1) / WORDS; // of each word
    localparam ADDRESS_WIDTH = $clog2(2 * COMPONENTS);
    localparam [31:0] SECOND_BANK = COMPONENTS;

    // ---- Banks, and the components that are read
    reg fill_bank;
    reg read_bank;
    reg [COMPONENT_WIDTH-1:0] beat;
    reg [ADDRESS_WIDTH-1:0] address_1;
    wire [31:0] component_wide = {{(32-COMPONENT_WIDTH){1'b0}}, g_component};
    wire [31:0] write_wide = component_wide >> WORD_WIDTH;
    wire [31:0] write_word = component_wide & (WORDS - 1);
    wire [31:0] read_wide = {{(32-COMPONENT_WIDTH){1'b0}}, beat};
    wire [ADDRESS_WIDTH-1:0] write_address = (fill_bank ? SECOND_BANK[ADDRESS_WIDTH-1:0] : {ADDRESS_WIDTH{1'b0}})
        + write_wide[ADDRESS_WIDTH-1:0];

    assign complete = g_last;

    always @(posedge clock) begin
        if (g_last) begin
            fill_bank <= !fill_bank;
        end
        if (release_frame) begin
            read_bank <= !read_bank;
        end
        if (enable) begin
            address_1 <= (read_bank ? SECOND_BANK[ADDRESS_WIDTH-1:0] : {ADDRESS_WIDTH{1'b0}})
                + read_wide[ADDRESS_WIDTH-1:0];
        end
        if (step) begin
            beat <= beat + 1;
        end
        if (rewind) begin
            beat <= {COMPONENT_WIDTH{1'b0}};
        end
        if (reset) begin
            fill_bank <= 1'b0;
            read_bank <= 1'b0;
        end
    end

    // ---- A memory for each word and q. Index k: k cycles after the beat
    genvar word;
    genvar q;
    genvar place;
    for (word = 0; word < WORDS; word = word + 1) begin : gen_words
        wire [3*27-1:0] wide_4;

        for (q = 0; q < 3; q = q + 1) begin : gen_memories
            wire signed [DATA_BITS-1:0] read_2;
            reg signed [DATA_BITS-1:0] read_3;
            reg signed [DATA_BITS-1:0] read_4;

            sptfra_ram #(
                .WIDTH         (DATA_BITS),
                .DEPTH         (2 * COMPONENTS),
                .ADDRESS_WIDTH (ADDRESS_WIDTH)
            ) coefficients (
                .clock         (clock),
                .write_enable  (g_valid[q] && (write_word == word)),
                .write_address (write_address),
                .write_data    (g),
                .read_enable   (enable),
                .read_address  (address_1),
                .read_data     (read_2)
            );

            always @(posedge clock) begin
                if (enable) begin
                    read_3 <= read_2;
                    read_4 <= read_3;
                end
            end

            for (place = 0; place < 27; place = place + 1) begin : gen_wide
                assign wide_4[27*q + place] = read_4[(place < DATA_BITS) ? place : DATA_BITS - 1];
            end
        end

        // ---- Stage 5: products; stage 6: the sum, with 16 fraction bits more
        reg [26:0] g0_5;
        wire signed [44:0] x_5;
        wire signed [44:0] y_5;
        reg signed [63:0] force_6;
        wire signed [63:0] g0_wide = {{21{g0_5[26]}}, g0_5, 16'd0};

        assign force_value[64*word +: 64] = force_6;

        sptfra_multiply multiplier_x (
            .clock       (clock),
            .enable      (enable),
            .coefficient (mu_x),
            .data        (wide_4[27*1 +: 27]),
            .product     (x_5)
        );

        sptfra_multiply multiplier_y (
            .clock       (clock),
            .enable      (enable),
            .coefficient (mu_y),
            .data        (wide_4[27*2 +: 27]),
            .product     (y_5)
        );

        always @(posedge clock) begin
            if (enable) begin
                g0_5 <= wide_4[27*0 +: 27];
                force_6 <= g0_wide + {{19{x_5[44]}}, x_5} + {{19{y_5[44]}}, y_5};
            end
        end
    end

    wire _unused = &{1'b0, write_wide, read_wide};

endmodule

`default_nettype wire
