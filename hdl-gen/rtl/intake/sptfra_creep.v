// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Correction of creep: each taxel's creep up to the frame before is subtracted from its reading.
//
// stress = reading - creep; creep += share * (strength * stress - creep). Reading to stress: 2 cycles; 7 to the creep
// kept, before the next frame's first reading comes. It is double-buffered: a frame writes the spare bank, and a good
// frame swaps the banks.

`default_nettype none

module sptfra_creep #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // {fraction bits, factor}: of the strength; of the share that creep goes on in a frame, 18 fraction bits and more
    parameter [22:0] STRENGTH = {6'd17, 17'd52429},
    parameter [22:0] SHARE = {6'd27, 17'd67109},
    // Full scale: what a larger stress becomes
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    input  wire reset,
    // Readings; with each what is kept beside it
    input  wire in_takes, // it is a taxel of the frame
    input  wire in_ends, // the frame ends, with its last taxel or behind it
    input  wire in_bad_length,
    input  wire [26:0] in_stress,
    input  wire [2:0] in_flags, // clipped, no number, in a dead taxel's place
    output wire busy, // from the last reading in to the last stress out
    // The same without creep
    output wire out_takes,
    output wire out_ends,
    output reg  out_bad_length,
    output reg  [26:0] out_stress,
    output wire [2:0] out_flags
);

    localparam FRACTION = 17; // of a creep, below a step of the stress
    localparam CREEP_BITS = 27 + FRACTION;
    localparam [CREEP_BITS-1:0] HALF = {{27{1'b0}}, 1'b1, {(FRACTION-1){1'b0}}}; // of a step: rounds what is cut
    localparam signed [27:0] MOST = {STRESS_BOUND[26], STRESS_BOUND};

    if (SHARE[22:17] <= FRACTION) begin : gen_check_share
        sptfra_error_the_share_has_18_fraction_bits_and_more invalid ();
    end

    // ---- Of the frame
    reg [TAXEL_WIDTH-1:0] place; // of the reading that comes
    reg bank; // of the creep of the last good frame
    reg holds; // there was one
    reg is_bad; // so far
    wire bad = is_bad || (in_takes && in_flags[1]);
    wire good_ends = in_ends && !bad && !in_bad_length;
    reg [7:1] takes;
    reg [2:1] ends;
    reg [5:0] flags; // of stages 1 and 2
    reg [7*(TAXEL_WIDTH+1)-1:0] places; // of stages 1 to 7, with the bank to be written
    wire [TAXEL_WIDTH:0] place_7 = places[7*(TAXEL_WIDTH+1)-1 -: TAXEL_WIDTH+1];

    assign busy = (ends != 2'd0);
    assign out_takes = takes[2];
    assign out_ends = ends[2];
    assign out_flags = flags[5:3];

    always @(posedge clock) begin
        takes <= {takes[6:1], in_takes};
        ends <= {ends[1], in_ends};
        flags <= {flags[2:0], in_flags};
        places <= {places[6*(TAXEL_WIDTH+1)-1:0], !bank, place};
        if (in_takes) begin
            place <= place + 1'b1;
            is_bad <= bad;
        end
        if (in_ends) begin
            out_bad_length <= in_bad_length;
        end
        if (good_ends) begin
            bank <= !bank;
            holds <= 1'b1;
        end
        if (reset || in_ends) begin
            place <= {TAXEL_WIDTH{1'b0}};
            is_bad <= 1'b0;
        end
        if (reset) begin
            takes <= 7'd0;
            ends <= 2'd0;
            bank <= 1'b0;
            holds <= 1'b0;
        end
    end

    // ---- Names end in the cycles since the reading
    wire [CREEP_BITS-1:0] kept_1;
    reg [26:0] reading_1;
    reg holds_1;
    wire signed [CREEP_BITS-1:0] creep_1 = holds_1 ? kept_1 : HALF;
    wire signed [27:0] stress_1 = $signed({reading_1[26], reading_1})
        - $signed({creep_1[CREEP_BITS-1], creep_1[CREEP_BITS-1:FRACTION]});
    wire signed [44:0] end_3;
    reg signed [26:0] end_4;
    wire signed [27:0] remaining_4;
    reg signed [26:0] half_remaining_5;
    wire signed [44:0] step_6;
    reg signed [CREEP_BITS-1:0] creep_2, creep_3, creep_4, creep_5, creep_6, creep_7;
    wire signed [44:0] creep_on_6 = $signed({creep_6[CREEP_BITS-1], creep_6})
        + (step_6 >>> (SHARE[22:17] - FRACTION - 1));
    wire signed [44:0] cut_3 = end_3 >>> STRENGTH[22:17];

    assign remaining_4 = $signed({end_4[26], end_4}) - $signed({creep_4[CREEP_BITS-1], creep_4[CREEP_BITS-1:FRACTION]});

    sptfra_multiply strength_multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient ({1'b0, STRENGTH[16:0]}),
        .data        (out_stress),
        .product     (end_3)
    );

    sptfra_multiply share_multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient ({1'b0, SHARE[16:0]}),
        .data        (half_remaining_5),
        .product     (step_6)
    );

    sptfra_ram #(
        .WIDTH         (CREEP_BITS),
        .DEPTH         (2 << TAXEL_WIDTH),
        .ADDRESS_WIDTH (TAXEL_WIDTH + 1)
    ) creeps (
        .clock         (clock),
        .write_enable  (takes[7]),
        .write_address (place_7),
        .write_data    (creep_7),
        .read_enable   (1'b1),
        .read_address  ({bank, place}),
        .read_data     (kept_1)
    );

    always @(posedge clock) begin
        reading_1 <= in_stress;
        holds_1 <= holds;
        out_stress <= (stress_1 > MOST) ? STRESS_BOUND : (stress_1 < -MOST) ? -STRESS_BOUND : stress_1[26:0];
        creep_2 <= creep_1;
        creep_3 <= creep_2;
        creep_4 <= creep_3;
        end_4 <= cut_3[26:0];
        creep_5 <= creep_4;
        half_remaining_5 <= remaining_4[27:1];
        creep_6 <= creep_5;
        creep_7 <= creep_on_6[CREEP_BITS-1:0];
    end

    wire _unused = &{1'b0, cut_3[44:27], remaining_4[0], creep_on_6[44]};

endmodule

`default_nettype wire
