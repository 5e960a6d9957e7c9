// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Replacement of dead taxels: each reading becomes a weighted sum of the other taxels.
//
// A frame is kept while one accumulator for each place adds up its sum, then read again with the sums in theirs. Last
// reading in to first one out: 7 cycles. `busy` keeps the next frame back until the last one is out. A frame comes out
// with as many readings as it came in, without those beyond the last taxel.

`default_nettype none

module sptfra_replace #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Places for dead taxels, 1 to 8
    parameter REPLACEABLE = 8,
    // 1: a calibration in RAM says which taxels are dead; 0: these are
    parameter MAPPED = 0,
    // Words of 16 bits. The lowest: how many taxels are dead, 3:0, fraction bits of the weights, 8:4. Then the taxels,
    // ascending
    parameter [16*REPLACEABLE+15:0] REPLACED = 0,
    // Full scale: what a larger sum becomes
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    input  wire reset,
    // Readings
    input  wire in_takes, // it is a taxel of the frame
    input  wire in_ends, // the frame ends, with its last taxel or behind it
    input  wire in_bad_length,
    input  wire [26:0] in_stress,
    input  wire in_saturated,
    input  wire in_not_finite,
    // Taxel of two cycles before its reading; of a calibration in RAM its map, the weights a cycle later
    input  wire [TAXEL_WIDTH-1:0] taxel_ahead,
    input  wire [34*REPLACEABLE+8:0] map,
    // The frame again
    output reg  busy, // from the last reading in to the last one out
    output wire out_valid,
    output wire out_last,
    output reg  out_bad_length,
    output reg  [26:0] out_stress,
    output reg  out_saturated,
    output reg  out_not_finite,
    output reg  out_replaced // a sum took the reading's place
);

    localparam signed [47:0] MOST = {{21{STRESS_BOUND[26]}}, STRESS_BOUND};

    if ((REPLACEABLE < 1) || (REPLACEABLE > 8)) begin : gen_check_map
        sptfra_error_places_for_dead_taxels_must_be_1_to_8 invalid ();
    end

    // ---- Weights of the reading that comes next; of the frame, which taxels are dead
    wire [18*REPLACEABLE-1:0] weights_ahead;
    wire [3:0] count;
    wire [4:0] weight_shift;
    wire [16*REPLACEABLE-1:0] taxels; // ascending

    if (MAPPED != 0) begin : gen_map
        assign {weights_ahead, count, weight_shift, taxels} = map;
        wire _unused_rom = &{1'b0, taxel_ahead, REPLACED, ROM_DIR != "", ROM_NAME != ""};
    end else begin : gen_neighbours
        assign count = REPLACED[3:0];
        assign weight_shift = REPLACED[8:4];
        assign taxels = REPLACED[16 +: 16*REPLACEABLE];

        sptfra_rom #(
            .WIDTH         (18 * REPLACEABLE),
            .DEPTH         (TAXELS),
            .ADDRESS_WIDTH (TAXEL_WIDTH),
            .ROM_DIR       (ROM_DIR),
            .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_neighbours.mem"})
        ) neighbours (
            .clock   (clock),
            .enable  (1'b1),
            .address (taxel_ahead),
            .data    (weights_ahead)
        );

        wire _unused_map = &{1'b0, map};
    end

    // ---- Keep: the frame as it comes, then once more from its first taxel
    reg [TAXEL_WIDTH-1:0] place; // of the reading that comes, or that is read again
    reg [TAXEL_WIDTH-1:0] end_place; // of the last reading
    reg [2:1] settles; // until the last product is in its sum
    reg replays;
    reg holds; // the sums are complete
    wire replays_last = replays && (place == end_place);

    always @(posedge clock) begin
        settles <= {settles[1], in_ends};
        holds <= settles[2];
        if (in_takes || replays) begin
            place <= place + 1'b1;
        end
        if (in_takes) begin
            end_place <= place;
        end
        if (in_ends) begin
            busy <= 1'b1;
            out_bad_length <= in_bad_length;
        end
        if (in_ends || replays_last) begin
            place <= {TAXEL_WIDTH{1'b0}};
            replays <= 1'b0;
        end
        if (settles[2]) begin
            replays <= 1'b1;
        end
        if (out_valid && out_last) begin
            busy <= 1'b0;
        end
        if (reset) begin
            place <= {TAXEL_WIDTH{1'b0}};
            settles <= 2'd0;
            replays <= 1'b0;
            holds <= 1'b0;
            busy <= 1'b0;
        end
    end

    wire [28:0] kept; // no number, clipped, stress

    sptfra_ram #(
        .WIDTH         (29),
        .DEPTH         (TAXELS),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) frame (
        .clock         (clock),
        .write_enable  (in_takes),
        .write_address (place),
        .write_data    ({in_not_finite, in_saturated, in_stress}),
        .read_enable   (1'b1),
        .read_address  (place),
        .read_data     (kept)
    );

    // ---- Sums, then the first of them that has not gone out, and whose it is
    reg [18*REPLACEABLE-1:0] weights;
    wire [48*REPLACEABLE-1:0] sums;
    reg [48*REPLACEABLE-1:0] waiting;
    reg [16*REPLACEABLE-1:0] waiting_taxels;
    reg [3:0] left;
    reg [4:0] shift_1;
    reg signed [47:0] half_1;
    reg valid_1;
    reg [15:0] taxel_1;
    wire dead_1 = valid_1 && (left != 4'd0) && (waiting_taxels[15:0] == taxel_1);
    wire [31:0] place_wide = {{(32-TAXEL_WIDTH){1'b0}}, place};
    genvar index;

    for (index = 0; index < REPLACEABLE; index = index + 1) begin : gen_sums
        wire signed [17:0] weight = weights[18*index +: 18];

        sptfra_mac neighbours (
            .clock       (clock),
            .reset       (reset),
            .valid       (in_takes),
            .first       (place == {TAXEL_WIDTH{1'b0}}),
            .coefficient (weight),
            .data        (in_stress),
            .accumulator (sums[48*index +: 48])
        );

        // Once the first has gone out, those behind it move up
        always @(posedge clock) begin
            if (holds) begin
                waiting[48*index +: 48] <= sums[48*index +: 48];
                waiting_taxels[16*index +: 16] <= taxels[16*index +: 16];
            end else if (dead_1) begin
                waiting[48*index +: 48] <= waiting[48*((index + 1) % REPLACEABLE) +: 48];
                waiting_taxels[16*index +: 16] <= waiting_taxels[16*((index + 1) % REPLACEABLE) +: 16];
            end
        end
    end

    always @(posedge clock) begin
        weights <= weights_ahead;
        valid_1 <= replays;
        taxel_1 <= place_wide[15:0];
        if (dead_1) begin
            left <= left - 4'd1;
        end
        if (holds) begin
            left <= count;
            shift_1 <= weight_shift;
            half_1 <= (48'sd1 <<< weight_shift) >>> 1;
        end
        if (reset) begin
            valid_1 <= 1'b0;
        end
    end

    // ---- Out: the sum rounded, then clipped, in place of what was read
    reg [4:2] valid;
    reg [4:1] lasts;
    reg [3:2] replaces;
    reg [4:0] shift_2;
    reg signed [47:0] sum_2;
    reg signed [47:0] sum_3;
    reg [28:0] read_2;
    reg [28:0] read_3;
    wire above = (sum_3 > MOST);
    wire below = (sum_3 < -MOST);
    wire signed [26:0] clipped = above ? STRESS_BOUND : below ? -STRESS_BOUND : $signed(sum_3[26:0]);

    assign out_valid = valid[4];
    assign out_last = lasts[4];

    always @(posedge clock) begin
        valid <= {valid[3:2], valid_1};
        lasts <= {lasts[3:1], replays_last};
        replaces <= {replaces[2], dead_1};
        out_replaced <= replaces[3];
        read_2 <= kept;
        read_3 <= read_2;
        shift_2 <= shift_1;
        sum_2 <= $signed(waiting[47:0]) + half_1;
        sum_3 <= sum_2 >>> shift_2;
        out_stress <= replaces[3] ? clipped : $signed(read_3[26:0]);
        out_saturated <= replaces[3] ? above || below : read_3[27];
        out_not_finite <= !replaces[3] && read_3[28];
        if (reset) begin
            valid <= 3'd0;
            lasts <= 4'd0;
        end
    end

    wire _unused = &{1'b0, place_wide[31:16]};

endmodule

`default_nettype wire
