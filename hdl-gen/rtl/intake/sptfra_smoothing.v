// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Exponential moving average of each taxel over frames, with the weight 2^-rate; a large step of any taxel restarts it.
//
// Latency: 4 cycles from a stress to the stress and its new average. One cycle after the frame's end `decided` says
// that it is known whether the frame is `averaged` or restarts the average. Then it is read out, a taxel a cycle.
// Averages are double-buffered: a frame writes the spare bank, and a good frame swaps the banks.

`default_nettype none

module sptfra_smoothing #(
    // Of a frame
    parameter TAXELS = 100,
    // A step beyond FACTOR / 2^FRACTION of the frame's largest stress restarts the average
    parameter FRACTION = 21,
    parameter [16:0] FACTOR = 17'd62915,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    input  wire reset,
    input  wire opens, // a frame begins to come in
    input  wire [3:0] rate, // of frames that begin from now on, 8 at most
    // Stresses
    input  wire in_takes, // it is a taxel of the frame
    input  wire in_ends, // the frame ends, with its last taxel or behind it
    input  wire in_bad_length,
    input  wire [26:0] in_stress,
    input  wire [2:0] in_flags, // clipped, no number, in a dead taxel's place
    output reg  busy, // from the last stress in to the last one out
    // The same, each with its average
    output wire out_takes,
    output wire out_ends,
    output wire out_bad_length,
    output wire [26:0] out_stress,
    output wire [26:0] out_average,
    output wire [2:0] out_flags,
    // Which of them the frame is made of
    output reg  decided, // until over
    output reg  averaged,
    input  wire over, // all is made of the frame
    // The frame
    output reg  shown_valid,
    output reg  shown_last,
    output reg  shown_replaced,
    output reg  [26:0] shown
);

    localparam [31:0] LAST_WIDE = TAXELS - 1;

    // ---- Of the frame
    reg [3:0] rate_held;
    reg [TAXEL_WIDTH-1:0] place; // of the stress that comes, or is shown
    reg bank; // of the current average
    reg holds; // a first frame has been averaged
    reg bank_averaged; // the bank's frame was made of averages
    reg is_bad; // so far
    reg is_bad_length;
    reg shows;
    reg shows_other; // a bad frame, which stays in the spare bank
    reg shows_1;
    reg shows_last_1;
    reg [4:1] takes;
    reg [4:1] ends;
    wire place_last = (place == LAST_WIDE[TAXEL_WIDTH-1:0]);

    // ---- Stage 1: what the average was. It has nine bits more, half a step of the stress is added: cut, it is rounded
    wire [63:0] kept_1; // replaced, stress, average
    reg [26:0] stress_1;
    reg [26:0] magnitude_1;
    wire signed [36:0] old_1 = bank_averaged ? $signed({kept_1[35], kept_1[35:0]})
        : $signed({kept_1[62], kept_1[62:36], 9'h100});

    // ---- Stages 2 to 4: what it becomes
    reg [26:0] stress_2;
    reg [26:0] stress_3;
    reg [26:0] stress_4;
    reg signed [36:0] old_2;
    reg signed [36:0] old_3;
    reg signed [36:0] step_2;
    reg signed [37:0] twice_3;
    reg signed [35:0] average_4;
    wire signed [37:0] rounded_3 = twice_3 + 38'sd1;
    wire signed [36:0] sum_3 = old_3 + rounded_3[37:1];
    reg [11:0] flags; // of stages 1 to 4
    reg [4*TAXEL_WIDTH-1:0] places;

    // ---- Largest stress and step, and the limit
    reg [26:0] most_2;
    wire [26:0] whole_2 = step_2[36] ? ~step_2[35:9] : step_2[35:9];
    reg [26:0] whole_3;
    reg [26:0] most_step_4;
    wire signed [44:0] product_low_3, product_high_3; // the product is their sum
    reg [44:0] limit_4;
    wire restarts_4 = !holds || ({18'd0, most_step_4} > limit_4);

    assign out_takes = takes[4];
    assign out_ends = ends[4];
    assign out_bad_length = is_bad_length;
    assign out_stress = stress_4;
    assign out_average = average_4[35:9];
    assign out_flags = flags[11:9];

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (1'b1),
        .coefficient ({1'b0, FACTOR}),
        .data        (most_2),
        .low         (product_low_3),
        .high        (product_high_3)
    );

    sptfra_ram #(
        .WIDTH         (64),
        .DEPTH         (2 << TAXEL_WIDTH),
        .ADDRESS_WIDTH (TAXEL_WIDTH + 1)
    ) averages (
        .clock         (clock),
        .write_enable  (takes[4]),
        .write_address ({!bank, places[4*TAXEL_WIDTH-1 -: TAXEL_WIDTH]}),
        .write_data    ({flags[9], stress_4, average_4}),
        .read_enable   (1'b1),
        .read_address  ({bank ^ shows_other, place}),
        .read_data     (kept_1)
    );

    always @(posedge clock) begin
        if (opens) begin
            rate_held <= rate;
        end
        takes <= {takes[3:1], in_takes};
        ends <= {ends[3:1], in_ends};
        places <= {places[3*TAXEL_WIDTH-1:0], place};
        flags <= {flags[8:0], in_flags};
        if (in_takes || shows) begin
            place <= place + 1'b1;
        end
        if (in_takes && in_flags[1]) begin
            is_bad <= 1'b1;
        end
        if (in_ends) begin
            busy <= 1'b1;
            is_bad_length <= in_bad_length;
        end
        if (reset || in_ends || (shows && place_last)) begin
            place <= {TAXEL_WIDTH{1'b0}};
        end

        stress_1 <= in_stress;
        magnitude_1 <= in_stress[26] ? -in_stress : in_stress;
        stress_2 <= stress_1;
        old_2 <= old_1;
        step_2 <= $signed({stress_1[26], stress_1, 9'h100}) - old_1;
        stress_3 <= stress_2;
        old_3 <= old_2;
        twice_3 <= $signed({step_2, 1'b0}) >>> rate_held;
        stress_4 <= stress_3;
        average_4 <= sum_3[35:0];

        if (takes[1] && (magnitude_1 > most_2)) begin
            most_2 <= magnitude_1;
        end
        // A dead taxel's own noise is that of a sum
        whole_3 <= (takes[2] && !flags[3]) ? whole_2 : 27'd0;
        if (whole_3 > most_step_4) begin
            most_step_4 <= whole_3;
        end
        limit_4 <= $unsigned(product_low_3 + product_high_3) >> FRACTION;

        if (ends[4]) begin
            busy <= 1'b0;
            decided <= 1'b1;
            averaged <= !restarts_4;
            shows <= 1'b1;
            shows_other <= is_bad || is_bad_length;
            if (!is_bad && !is_bad_length) begin
                bank <= !bank;
                bank_averaged <= !restarts_4;
                holds <= 1'b1;
            end
        end
        shows_1 <= shows;
        shows_last_1 <= shows && place_last;
        shown_valid <= shows_1;
        shown_last <= shows_last_1;
        shown_replaced <= kept_1[63];
        shown <= averaged ? kept_1[35:9] : kept_1[62:36];
        if (shows && place_last) begin
            shows <= 1'b0;
            shows_other <= 1'b0;
        end
        if (reset || ends[4]) begin
            most_2 <= 27'd0;
            most_step_4 <= 27'd0;
            is_bad <= 1'b0;
        end
        if (reset || over) begin
            decided <= 1'b0;
        end
        if (reset) begin
            takes <= 4'd0;
            ends <= 4'd0;
            busy <= 1'b0;
            bank <= 1'b0;
            bank_averaged <= 1'b0;
            holds <= 1'b0;
            averaged <= 1'b0;
            shows <= 1'b0;
            shows_other <= 1'b0;
            shows_1 <= 1'b0;
            shows_last_1 <= 1'b0;
            shown_valid <= 1'b0;
            shown_last <= 1'b0;
        end
    end

    wire _unused = &{1'b0, rounded_3[0], sum_3[36], step_2[8:0], LAST_WIDE};

endmodule

`default_nettype wire
