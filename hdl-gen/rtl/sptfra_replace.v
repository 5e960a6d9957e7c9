// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Gives each taxel that a frame's bank says is dead a weighted sum of the others in place of its own reading: as
// sptfra_dead_taxels, with map and weights from a bank of the calibration (sptfra_dead_bank).
//
// A frame is kept while one accumulator for each place of the map adds up its sum, then read again with the sums in
// theirs. Last reading in to first one out: 7 cycles. The next frame may begin while this one is read again; `hold`
// keeps it back until then. A frame comes out with as many readings as it came in, one too many where there were more.

`default_nettype none

module sptfra_replace #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Places of the map: 1, 2, 4 or 8
    parameter REPLACEABLE = 8,
    // Full scale: what a larger sum becomes
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // Frames before their readings
    input  wire begins,
    output reg  hold, // one has begun and is not complete: no other may
    // Readings
    input  wire in_valid,
    input  wire in_last,
    input  wire signed [26:0] in_stress,
    input  wire in_not_finite,
    // What the bank of the frame that is kept has: of the reading that comes next; of the frame
    input  wire [18*REPLACEABLE-1:0] weights_ahead,
    input  wire [3:0] count,
    input  wire [4:0] weight_shift,
    input  wire [16*REPLACEABLE-1:0] taxels, // ascending
    // The frame again
    output wire out_valid,
    output wire out_last,
    output wire signed [26:0] out_stress,
    output wire out_not_finite,
    // Sum of the magnitudes that took a reading's place, of the oldest frame that has left and was not taken
    output wire [29:0] replaced,
    input  wire replaced_take
);

    localparam TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1;
    localparam INDEX_WIDTH = $clog2(TAXELS + 1);
    localparam [31:0] TAXELS_WIDE = TAXELS;
    localparam [INDEX_WIDTH-1:0] BEYOND = TAXELS_WIDE[INDEX_WIDTH-1:0];
    localparam signed [47:0] MOST = {{21{STRESS_BOUND[26]}}, STRESS_BOUND};

    generate
        if ((REPLACEABLE != 1) && (REPLACEABLE != 2) && (REPLACEABLE != 4) && (REPLACEABLE != 8)) begin : gen_check_map
            sptfra_error_replaceable_must_be_1_2_4_or_8 invalid ();
        end
    endgenerate

    // ---- Keep: the frame as it comes, then once more from its first taxel
    reg [INDEX_WIDTH-1:0] place; // of the reading that comes, stops behind the last taxel
    reg [INDEX_WIDTH-1:0] ends_at; // place of the last reading
    reg [2:1] settles; // until the last product is in its sum
    reg pending; // complete, but the frame before is not read again yet
    reg replays;
    reg [INDEX_WIDTH-1:0] replay_place;
    reg [INDEX_WIDTH-1:0] replay_end;
    reg holds; // the sums are complete
    wire takes = in_valid && (place != BEYOND);
    wire replays_last = replays && (replay_place == replay_end);
    wire complete = settles[2] || pending;
    wire start = complete && (!replays || replays_last);

    always @(posedge clock) begin
        if (advance) begin
            settles <= {settles[1], in_valid && in_last};
            pending <= complete && !start;
            holds <= start;
            if (in_valid) begin
                place <= in_last ? {INDEX_WIDTH{1'b0}} : takes ? place + 1 : place;
            end
            if (in_valid && in_last) begin
                ends_at <= place;
            end
            replay_place <= replay_place + 1;
            if (replays_last) begin
                replays <= 1'b0;
            end
            if (start) begin
                replays <= 1'b1;
                replay_place <= {INDEX_WIDTH{1'b0}};
                replay_end <= ends_at;
            end
            if (holds) begin
                hold <= 1'b0;
            end
        end
        if (begins) begin
            hold <= 1'b1;
        end
        if (reset) begin
            place <= {INDEX_WIDTH{1'b0}};
            settles <= 2'd0;
            pending <= 1'b0;
            replays <= 1'b0;
            holds <= 1'b0;
            hold <= 1'b0;
        end
    end

    wire signed [26:0] kept_stress;
    wire kept_not_finite;
    // What is beyond the last taxel is nothing
    wire [INDEX_WIDTH-1:0] replay_taxel = (replay_place == BEYOND) ? {INDEX_WIDTH{1'b0}} : replay_place;

    sptfra_ram #(
        .WIDTH         (28),
        .DEPTH         (TAXELS),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) frame (
        .clock         (clock),
        .write_enable  (takes && advance),
        .write_address (place[TAXEL_WIDTH-1:0]),
        .write_data    ({in_not_finite, in_stress}),
        .read_enable   (advance),
        .read_address  (replay_taxel[TAXEL_WIDTH-1:0]),
        .read_data     ({kept_not_finite, kept_stress})
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
    wire [31:0] replay_wide = {{(32-INDEX_WIDTH){1'b0}}, replay_place};
    genvar index;

    generate
        for (index = 0; index < REPLACEABLE; index = index + 1) begin : gen_sums
            wire signed [17:0] weight = weights[18*index +: 18];

            sptfra_mac neighbours (
                .clock       (clock),
                .reset       (reset),
                .valid       (takes && advance),
                .first       (place == {INDEX_WIDTH{1'b0}}),
                .coefficient (weight),
                .data        (in_stress),
                .accumulator (sums[48*index +: 48])
            );

            // Once the first has gone out, those behind it move up
            always @(posedge clock) begin
                if (advance && holds) begin
                    waiting[48*index +: 48] <= sums[48*index +: 48];
                    waiting_taxels[16*index +: 16] <= taxels[16*index +: 16];
                end else if (advance && dead_1) begin
                    waiting[48*index +: 48] <= waiting[48*((index + 1) % REPLACEABLE) +: 48];
                    waiting_taxels[16*index +: 16] <= waiting_taxels[16*((index + 1) % REPLACEABLE) +: 16];
                end
            end
        end
    endgenerate

    always @(posedge clock) begin
        if (advance) begin
            weights <= weights_ahead;
            valid_1 <= replays;
            taxel_1 <= replay_wide[15:0];
            if (dead_1) begin
                left <= left - 4'd1;
            end
            if (holds) begin
                left <= count;
                shift_1 <= weight_shift;
                half_1 <= (48'sd1 <<< weight_shift) >>> 1;
            end
        end
        if (reset) begin
            valid_1 <= 1'b0;
        end
    end

    // ---- Out: the sum rounded, then clipped, in place of what was read
    reg [4:2] valid;
    reg [4:1] lasts;
    reg [3:2] replaces;
    reg replaces_4;
    reg [4:0] shift_2;
    reg signed [47:0] sum_2;
    reg signed [47:0] sum_3;
    reg [27:0] read_2;
    reg [27:0] read_3;
    reg signed [26:0] stress_4;
    reg not_finite_4;
    reg [29:0] replaced_before; // without that of the reading that goes out
    wire above = (sum_3 > MOST);
    wire below = (sum_3 < -MOST);
    wire signed [26:0] clipped = above ? STRESS_BOUND : below ? -STRESS_BOUND : $signed(sum_3[26:0]);
    wire [26:0] magnitude = stress_4[26] ? -stress_4 : stress_4;
    wire [29:0] replaced_here = replaced_before + (replaces_4 ? {3'd0, magnitude} : 30'd0);

    assign out_valid = valid[4];
    assign out_last = lasts[4];
    assign out_stress = stress_4;
    assign out_not_finite = not_finite_4;

    always @(posedge clock) begin
        if (advance) begin
            valid <= {valid[3:2], valid_1};
            lasts <= {lasts[3:1], replays_last};
            replaces <= {replaces[2], dead_1};
            replaces_4 <= replaces[3];
            read_2 <= {kept_not_finite, kept_stress};
            read_3 <= read_2;
            shift_2 <= shift_1;
            sum_2 <= $signed(waiting[47:0]) + half_1;
            sum_3 <= sum_2 >>> shift_2;
            stress_4 <= replaces[3] ? clipped : $signed(read_3[26:0]);
            not_finite_4 <= !replaces[3] && read_3[27];
            if (valid[4]) begin
                replaced_before <= out_last ? 30'd0 : replaced_here;
            end
        end
        if (reset) begin
            valid <= 3'd0;
            replaced_before <= 30'd0;
        end
    end

    // ---- Frames between here and Bz: three ends before the skid buffer, two in it, one in Bz
    reg [29:0] replaced_of [0:7];
    reg [2:0] newest;
    reg [2:0] oldest;

    assign replaced = replaced_of[oldest];

    always @(posedge clock) begin
        if (advance && out_valid && out_last) begin
            replaced_of[newest] <= replaced_here;
            newest <= newest + 3'd1;
        end
        if (replaced_take) begin
            oldest <= oldest + 3'd1;
        end
        if (reset) begin
            newest <= 3'd0;
            oldest <= 3'd0;
        end
    end

    wire _unused = &{1'b0, replay_wide[31:16], replay_taxel};

endmodule

`default_nettype wire
