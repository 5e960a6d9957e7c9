// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The frame that a body would cause alone, in float32: what it causes where others are, and in its own region what is
// left of the frame without them, so that the frames of all bodies add up to it. Where the sensor reads no tension,
// what pulls is nothing in these frames either.
//
// A word takes as many cycles as there are bodies, and the first one 14 more. All of it stands still while a word
// waits.

`default_nettype none

module sptfra_parted_frames #(
    // Taxels
    parameter TAXELS = 100,
    // Bits of the number of a body
    parameter BODY_WIDTH = 2,
    // Power of two of a step of the parts, over that of the forces
    parameter signed [9:0] UNIT = 10'sd0,
    // 1: the sensor reads no tension
    parameter CLIPPED = 0,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3
) (
    input  wire clock,
    input  wire reset,
    input  wire start,
    input  wire [3:0] kept, // bodies; held, with what follows, until the last word is taken
    input  wire [3:0] body,
    input  wire signed [9:0] unit, // power of two of a step of the forces
    output wire advance,
    // Of the taxel asked for its region, its stress and what the body asked for causes there: 1 cycle, where advance
    output wire [TAXEL_WIDTH-1:0] taxel,
    output wire [BODY_WIDTH+TAXEL_WIDTH-1:0] part_address,
    input  wire [2:0] region,
    input  wire [31:0] stress,
    input  wire signed [47:0] part,
    output wire clips, // the stress of a taxel
    // The frame
    output wire [31:0] word,
    output wire word_last,
    output wire word_valid,
    input  wire word_ready
);

    localparam [31:0] LAST_TAXEL = TAXELS - 1;
    localparam ALIGN = 4;
    localparam TO_FLOAT = 7;

    assign advance = word_ready || !word_valid;

    // ---- Stage 0: each taxel, and for each the bodies
    reg busy;
    reg [TAXEL_WIDTH-1:0] place;
    reg [TAXEL_WIDTH-1:0] place_1; // a cycle later
    reg [3:0] of;
    wire last_of = (of + 4'd1 == kept);
    wire last_place = (place == LAST_TAXEL[TAXEL_WIDTH-1:0]);

    // Of a word that waits it is asked for again
    assign taxel = advance ? place : place_1;
    assign part_address = {of[BODY_WIDTH-1:0], place};

    always @(posedge clock) begin
        if (busy && advance) begin
            of <= last_of ? 4'd0 : of + 4'd1;
            if (last_of) begin
                place <= place + 1'b1;
                busy <= !last_place;
            end
        end
        if (start) begin
            busy <= 1'b1;
            place <= {TAXEL_WIDTH{1'b0}};
            of <= 4'd0;
        end
        if (reset) begin
            busy <= 1'b0;
        end
    end

    // ---- Stage 1: what was asked for; stage 5: the stress in steps of the parts
    reg valid_1, first_1, last_of_1, last_1;
    reg is_body_1;
    wire is_own_1 = ({1'b0, region} == body);
    reg [ALIGN+1:2] valids, firsts, lasts_of, lasts, are_own, are_body;
    reg signed [47:0] part_2, part_3, part_4, part_5;
    wire [46:0] magnitude;
    wire negative;
    wire clipped_4;
    wire signed [47:0] stress_5;

    sptfra_align #(
        .WIDTH (48)
    ) align (
        .clock      (clock),
        .enable     (advance),
        .float_bits (stress),
        .unit       (unit + UNIT),
        .magnitude  (magnitude),
        .negative   (negative),
        .clipped    (clipped_4),
        .fixed      (stress_5)
    );

    assign clips = valids[ALIGN] && clipped_4;

    always @(posedge clock) begin
        if (advance) begin
            valid_1 <= busy;
            first_1 <= (of == 4'd0);
            last_of_1 <= last_of;
            last_1 <= last_place;
            is_body_1 <= (of == body);
            place_1 <= place;
            valids <= {valids[ALIGN:2], valid_1};
            firsts <= {firsts[ALIGN:2], first_1};
            lasts_of <= {lasts_of[ALIGN:2], last_of_1};
            lasts <= {lasts[ALIGN:2], last_1};
            are_own <= {are_own[ALIGN:2], is_own_1};
            are_body <= {are_body[ALIGN:2], is_body_1};
            {part_5, part_4, part_3, part_2} <= {part_4, part_3, part_2, part};
        end
        if (reset) begin
            valid_1 <= 1'b0;
            valids <= {ALIGN{1'b0}};
        end
    end

    // ---- Stage 6: in its own region the frame without the others, elsewhere its part
    reg signed [51:0] sum_6;
    reg complete_6;
    reg last_6;
    wire counts_5 = (are_own[5] != are_body[5]);
    wire signed [51:0] from_5 = !firsts[5] ? sum_6 : are_own[5] ? $signed({{4{stress_5[47]}}, stress_5}) : 52'sd0;
    wire signed [51:0] wide_5 = $signed({{4{part_5[47]}}, part_5});
    wire signed [51:0] term_5 = !counts_5 ? 52'sd0 : are_own[5] ? ~wide_5 : wide_5;
    wire minus_5 = counts_5 && are_own[5];

    always @(posedge clock) begin
        if (advance) begin
            if (valids[5]) begin
                sum_6 <= from_5 + term_5 + $signed({51'd0, minus_5});
            end
            complete_6 <= valids[5] && lasts_of[5];
            last_6 <= lasts[5];
        end
        if (reset) begin
            complete_6 <= 1'b0;
        end
    end

    // ---- Stage 13: the word
    reg [TO_FLOAT:1] complete_later;
    reg [TO_FLOAT:1] last_later;
    wire signed [51:0] kept_6 = ((CLIPPED != 0) && !sum_6[51]) ? 52'sd0 : sum_6;

    sptfra_fixed_to_float to_float (
        .clock      (clock),
        .enable     (advance),
        .fixed      ({{12{kept_6[51]}}, kept_6}),
        .exponent   (unit + UNIT),
        .float_bits (word)
    );

    always @(posedge clock) begin
        if (advance) begin
            complete_later <= {complete_later[TO_FLOAT-1:1], complete_6};
            last_later <= {last_later[TO_FLOAT-1:1], last_6};
        end
        if (reset) begin
            complete_later <= {TO_FLOAT{1'b0}};
        end
    end

    assign word_valid = complete_later[TO_FLOAT];
    assign word_last = last_later[TO_FLOAT];

    wire _unused = &{1'b0, magnitude, negative};

endmodule

`default_nettype wire
